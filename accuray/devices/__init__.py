"""Devices: where samples are computed. For now the processor of this machine."""

from accuray.devices.cpu import LoadedScene, load

__all__ = ["LoadedScene", "load"]
