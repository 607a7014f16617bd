#pragma once

#include "chosen.h"
#include "fast/tile/serial_tree.h"
#include "tracer.h"

namespace nuvo {

/// Pixels by the serial tracer, for one thread.
class SerialPixels {
  public:
    explicit SerialPixels(SerialTree& tree)
        : kernel_(tree.scene().scene(), tree.scene().primitives(), std::nullopt,
                  tree.scene().back_faces()),
          tracer_(tree.scene().scene(), kernel_,
                  Search(kernel_, tree.scene().primitives(), tree.octree(), NoCounter{})) {}
    SerialPixels(const SerialPixels&) = delete;
    SerialPixels& operator=(const SerialPixels&) = delete;

    /// `ray` has unit direction.
    Rgb8 pixel(const Ray& ray) { return quantized(tracer_.color(ray)); }

  private:
    using Search = ExactSearch<ExactKernel, DescentLocator, NoCounter>;

    ExactKernel kernel_;
    Tracer<ExactKernel, Search> tracer_;
};

}  // namespace nuvo
