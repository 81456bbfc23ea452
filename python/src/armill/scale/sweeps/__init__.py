"""Predefined sweeps, one file each, with their columns."""
