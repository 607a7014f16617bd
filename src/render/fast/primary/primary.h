#pragma once

#include "fast/camera/camera_tables.h"
#include "fast/primary/macro_tile.h"
#include "fast/primary/plane_order.h"
#include "fast/tile/exact_fallback.h"
#include "fast/tile/mailbox.h"

// Primary rays: the octree is walked once a macro tile, from near to far; what a leaf holds is
// tested against tiles and blocks first, then against 16 rays at a time.

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

/// Finds the nearest primitives of a macro tile whose x and y are set; fills the rest, and normals
/// of ellipsoids that the exact fallback decided, unless they are null.
class PrimaryStage {
  public:
    explicit PrimaryStage(InstructionSet isa);
    void trace(PrimaryJob& job, MacroTile& tile, EllipsoidNormals* normals) const {
        trace_(job, tile, normals);
    }

  private:
    void (*trace_)(PrimaryJob&, MacroTile&, EllipsoidNormals*);
};

}  // namespace nuvo
