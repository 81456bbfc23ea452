"""Tests of sweeps: requests, folders, backends, predefined sweeps."""
