#pragma once

#include <vector>

#include "fast/scene/fast_scene.h"
#include "nuvo/image/image.h"
#include "nuvo/render/fast.h"

namespace nuvo {

/// All that one picture needs, and the loop over its tiles.
class Frame {
  public:
    Frame(const FastScene& scene, const FastOptions& options, Resolution resolution);
    ~Frame();

    /// `options.threads` threads take tiles from one counter.
    Image render(FastTimes* times);
    /// Bytes of the tables.
    std::size_t memory_bytes() const;

  private:
    struct Tables;
    class Worker;

    const FastScene& scene_;
    FastOptions options_;
    std::unique_ptr<Tables> tables_;
    double table_seconds_ = 0;
};

}  // namespace nuvo
