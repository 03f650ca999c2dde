"""PC2 point caches: little-endian "POINTCACHE2\\0", int32 1, int32 points, float32 start, float32 rate,
int32 samples, then float32 xyz of every point and sample. No Blender needed."""

import os
import struct

import numpy as np

HEADER = struct.Struct("<12siiffi")
MAGIC = b"POINTCACHE2\0"


class Reader:
    """Reads samples of a cache that may still grow; ValueError if the file is not a cache."""

    def __init__(self, path):
        self.path = path
        self.points, self._promised = self._header()

    def _header(self):
        with open(self.path, "rb") as file:
            head = file.read(HEADER.size)
        if len(head) < HEADER.size:
            raise ValueError(f"{self.path} is not a PC2 cache")
        magic, version, points, _, _, samples = HEADER.unpack(head)
        if magic != MAGIC or version != 1 or points < 0 or samples < 0:
            raise ValueError(f"{self.path} is not a PC2 cache")
        return points, samples

    def samples(self):
        """Number of complete samples at present."""
        _, promised = self._header()
        if self.points == 0:
            return promised
        return min(promised, (os.path.getsize(self.path) - HEADER.size) // (12 * self.points))

    def read(self, sample):
        """(#points, 3) float64."""
        with open(self.path, "rb") as file:
            file.seek(HEADER.size + sample * 12 * self.points)
            data = np.frombuffer(file.read(12 * self.points), "<f4")
        if data.size != 3 * self.points:
            raise ValueError(f"{self.path} has no sample {sample}")
        return data.reshape(-1, 3).astype(float)


class Writer:
    """A new cache, or with `keep` the first samples of one that is there. The header never promises a sample
    that is not written."""

    def __init__(self, path, points, keep=0):
        self.path, self.points, self.samples = path, points, keep
        self._file = open(path, "r+b" if keep else "w+b")
        self._file.truncate(HEADER.size + keep * 12 * points)
        self._write_header()

    def _write_header(self):
        self._file.seek(0)
        self._file.write(HEADER.pack(MAGIC, 1, self.points, 0.0, 1.0, self.samples))

    def append(self, positions):
        positions = np.asarray(positions)
        if positions.shape != (self.points, 3):
            raise ValueError(f"{positions.shape[0]} points for a cache of {self.points}")
        self._file.seek(HEADER.size + self.samples * 12 * self.points)
        self._file.write(np.ascontiguousarray(positions, "<f4").tobytes())
        self.samples += 1
        self._write_header()

    def cut(self, samples):
        """Drops all but the first `samples` samples."""
        if samples < self.samples:
            self.samples = samples
            self._write_header()
            self._file.truncate(HEADER.size + samples * 12 * self.points)

    def flush(self):
        self._file.flush()

    def close(self):
        self._file.close()
