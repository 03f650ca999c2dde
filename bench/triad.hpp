// The memory bandwidth of this machine, as STREAM measures it (McCalpin 1995).
#pragma once

namespace muslin::bench {

/// Bytes per second of a[i] = b[i] + s c[i] over arrays far larger than the caches, counting 24 bytes an
/// element, with as many threads as muslin may use; the best of several passes.
double stream_triad();

}  // namespace muslin::bench
