"""Sweeps: what is asked, folders, backends, and those that are ready-made."""
