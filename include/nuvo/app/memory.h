#pragma once

#include <cstddef>

#include "nuvo/render/primitives.h"
#include "nuvo/scene/scene.h"

namespace nuvo::app {

/// The largest resident size of the process so far, in bytes; 0 where the system does not tell.
std::size_t peak_memory_bytes();

/// Bytes that a loaded scene holds.
std::size_t memory_bytes(const Scene& scene);
/// Bytes that the flattened scene holds.
std::size_t memory_bytes(const Primitives& primitives);

/// Of a run, in bytes: what its parts hold, and how large the process had been after each stage.
struct RunMemory {
    std::size_t scene = 0;
    std::size_t peak_start = 0;  ///< before the scene was read
    std::size_t peak_reading = 0;
};

/// Of a pass, whose octree and tables tell their own bytes.
struct PassMemory {
    std::size_t primitives = 0;
    std::size_t tracer = 0;         ///< copies of the serial one, while it traces
    std::size_t picture = 0;        ///< samples included
    std::size_t peak_building = 0;  ///< of the first repetition, as the next
    std::size_t peak_tracing = 0;
};

}  // namespace nuvo::app
