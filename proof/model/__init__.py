"""The paper's 28-degree-of-freedom machine written a second time, with other laws and another integrator."""
