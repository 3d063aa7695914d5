"""Devices: where samples are computed. For now the processor of this machine."""

from accuray.devices.cpu import LoadedScene, build_info, load
from accuray.devices.rgb_table import cache_folder

__all__ = ["LoadedScene", "build_info", "cache_folder", "load"]
