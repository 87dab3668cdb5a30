"""Concealed cases: an independent simulator hides an effect, the reconcile engine must find it."""
