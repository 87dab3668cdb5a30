"""Concealed cases of machines without teeth: a disc on a shaft in two bearings, loaded by its weight."""
