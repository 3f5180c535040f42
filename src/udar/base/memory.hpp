#pragma once

namespace udar {

/// Bytes that this process may still take: what the system says is available, swap included, and no more than the
/// limits of the process (`ulimit -v`) and of its control group leave. Infinite where nothing is known.
double memory_there();

}  // namespace udar
