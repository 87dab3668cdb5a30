"""Physics of gear-rotor-bearing machines: specification in, arrays out. No web, no queue, no clock."""
