# SPDX-FileCopyrightText: 2026 the prodomos authors
# SPDX-License-Identifier: BSD-3-Clause
"""Logs of a few kilobytes, written by tests."""

import struct
import zlib


def carmen_log(scans=60, ranges=lambda scan: ["2.00"] * 180):
    """A robot drives a metre a scan."""
    lines = ["# CARMEN Logfile", "PARAM robot_front_laser_max 20.0"]
    for scan in range(scans):
        pose = f"{scan}.0 0.0 0.0"
        lines.append(f"FLASER 180 {' '.join(ranges(scan))} {pose} {pose} {1000 + scan}.0 host {scan}.0")
    return "\n".join(lines) + "\n"


def png(width, height, depth, channels, sample):
    """A PNG of one value everywhere."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    line = b"\0" + sample.to_bytes(depth // 8, "big") * channels * width
    header = struct.pack(">IIBBBBB", width, height, depth, {1: 0, 3: 2}[channels], 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(line * height)) + chunk(b"IEND", b"")
