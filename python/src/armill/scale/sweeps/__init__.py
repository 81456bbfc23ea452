"""Sweeps that are ready-made: a file each with what it asks and the columns that it gives."""
