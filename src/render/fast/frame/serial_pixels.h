#pragma once

#include <algorithm>

#include "chosen.h"
#include "fast/tile/serial_tree.h"
#include "nuvo/image/image.h"
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

    /// Those of a square of the picture.
    void draw(const RayGenerator& rays, int left, int top, int side, Image& image) {
        for (int y = top; y < std::min(top + side, image.height()); ++y)
            for (int x = left; x < std::min(left + side, image.width()); ++x)
                image.at(x, y) = quantized(tracer_.color(rays.ray(x, y)));
    }

  private:
    using Search = ExactSearch<ExactKernel, DescentLocator, NoCounter>;

    ExactKernel kernel_;
    Tracer<ExactKernel, Search> tracer_;
};

}  // namespace nuvo
