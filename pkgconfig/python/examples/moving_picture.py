"""Springs as an animated PNG, by numpy and zlib.

SPDX-License-Identifier: MIT
"""
import struct
import zlib

import numpy as np

FINE = 3  # fine pixels along a pixel
SHADES = 6  # of red, of green and of blue: 216 colours take a byte
PALETTE = np.array([[255, 255, 255], [51, 51, 51], [204, 204, 204]], np.float32)  # air, line of the ground, ground
COLD, CALM, HOT = np.array([[40, 90, 190], [60, 60, 70], [210, 60, 40]], np.float32)


class MovingPicture:
    """Frames of width x height pixels, metres wide, dt seconds apart. The camera follows."""

    def __init__(self, width, height, metres, dt):
        self.width, self.height, self.scale, self.dt = width, height, FINE * width / metres, dt
        self.frames = []

    def add(self, positions, ends, strains, middle):
        """Draw springs, red where they are stretched by 20 %, blue where they are pressed so."""
        canvas = np.empty((FINE * self.height, FINE * self.width, 3), np.float32)
        canvas[:] = PALETTE[0]
        floor = canvas.shape[0] - int(0.15 * canvas.shape[0])
        self._draw_ground(canvas, floor, middle)
        share = np.linspace(0, 1, 40)[None, :, None]
        a, b = positions[ends[:, 0]][:, None], positions[ends[:, 1]][:, None]
        points = (a + share * (b - a)) * self.scale
        column = np.rint(points[..., 0] - middle * self.scale + canvas.shape[1] / 2).astype(int)
        row = np.rint(floor - points[..., 1]).astype(int)
        heat = np.clip(strains / 0.2, -1, 1)[:, None]
        color = np.where(heat > 0, CALM + heat * (HOT - CALM), CALM - heat * (COLD - CALM))
        for up in (-1, 0, 1, 2):
            for right in (-1, 0, 1, 2):
                i, j = np.clip(row + up, 0, canvas.shape[0] - 1), np.clip(column + right, 0, canvas.shape[1] - 1)
                canvas[i, j] = color[:, None]
        small = canvas.reshape(self.height, FINE, self.width, FINE, 3).mean((1, 3))
        self.frames.append((small * ((SHADES - 1) / 255) + 0.5).astype(np.uint8) @ (SHADES ** np.arange(3, dtype=np.uint8)))

    def _draw_ground(self, canvas, floor, middle):
        canvas[floor:] = PALETTE[2]
        metre = (np.arange(canvas.shape[1]) - canvas.shape[1] / 2) / self.scale + middle
        canvas[floor:, np.floor(2 * metre) % 2 == 0] *= 0.75  # stripes of half a metre show the motion
        canvas[floor:floor + FINE] = PALETTE[1]

    def save(self, path):
        """Write all frames. Programs that know no animations show the first."""
        with open(path, "wb") as file:
            file.write(b"\x89PNG\r\n\x1a\n")
            self._chunk(file, b"IHDR", struct.pack(">IIBBBBB", self.width, self.height, 8, 3, 0, 0, 0))
            shades = np.arange(SHADES ** 3)[:, None] // SHADES ** np.arange(3) % SHADES
            self._chunk(file, b"PLTE", (shades * (255 // (SHADES - 1))).astype(np.uint8).tobytes())
            self._chunk(file, b"acTL", struct.pack(">II", len(self.frames), 0))
            number = 0
            for index, frame in enumerate(self.frames):
                size = (self.width, self.height, 0, 0, int(1000 * self.dt), 1000, 0, 0)
                self._chunk(file, b"fcTL", struct.pack(">IIIIIHHBB", number, *size))
                data = zlib.compress(np.pad(frame, ((0, 0), (1, 0))).tobytes(), 9)  # each row begins with its filter: none
                self._chunk(file, *((b"IDAT", data) if index == 0 else (b"fdAT", struct.pack(">I", number + 1) + data)))
                number += 1 if index == 0 else 2
            self._chunk(file, b"IEND", b"")

    @staticmethod
    def _chunk(file, kind, data):
        file.write(struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)))
