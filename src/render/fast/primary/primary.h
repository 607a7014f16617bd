#pragma once

#include "fast/primary/camera_tables.h"
#include "fast/primary/plane_order.h"
#include "fast/scene/mailbox.h"
#include "fast/tile/exact_fallback.h"
#include "fast/tile/tile.h"

// Primary rays: the octree is walked once a tile, by the beam of all its rays; in a leaf each
// primitive is tested against whole blocks first, then against 16 rays at a time.

namespace nuvo {

/// What all tiles of a thread share.
struct PrimaryJob {
    const FastScene& scene;
    const CameraRays& camera;
    const CameraTables& tables;
    const ExactFallback& fallback;
    bool redo_exactly;
    Mailbox mailbox;
    PlaneOrders orders{scene, camera};
};

/// Finds the nearest primitives of a tile whose x and y are set; fills `inside` and the fields of
/// primary rays.
class PrimaryStage {
  public:
    explicit PrimaryStage(InstructionSet isa);
    void trace(PrimaryJob& job, Tile& tile) const { trace_(job, tile); }

  private:
    void (*trace_)(PrimaryJob&, Tile&);
};

}  // namespace nuvo
