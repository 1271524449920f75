"""Firmware for boards whose own ROM shows itself as a drive.

In: a UF2 file, a drive on this computer. Out: the port on which the board came back.
Read ``uf2_blocks``, the format; ``copy_firmware``.
"""
