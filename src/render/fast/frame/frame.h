#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "fast/frame/kept_tables.h"
#include "fast/tile/serial_tree.h"
#include "nuvo/image/image.h"
#include "nuvo/render/fast.h"

namespace nuvo {

/// For which items shadows are made: for all before the first pixel, or, once it is known what all
/// pixels show, for those that may stand before some lit point; kKept: as for another picture, if
/// that is kept; kByLight: for one light after the other. Pictures are the same.
enum class ShadowListing : std::uint8_t { kMeasured, kAll, kWanted, kKept, kByLight };

class StageClock;

/// All that one picture needs, and the loop over its tiles.
class Frame {
  public:
    /// Whether floats tell enough of the scene as its camera sees it.
    static bool can_show(const FastScene& scene, Resolution resolution);

    /// Adds to `times` if it is given. Keeps references.
    Frame(SerialTree& serial, const FastOptions& options, Resolution resolution, FastTimes* times,
          KeptTables& kept, ShadowListing listing = ShadowListing::kMeasured);
    ~Frame();

    /// `options.threads` threads take tiles from one counter. Once.
    Image render();
    /// Bytes of the tables that the picture took.
    std::size_t memory_bytes() const;

  private:
    struct Hits;
    struct Tables;
    class Worker;

    template <typename Work>
    void for_each_tile(Work&& work);
    void find_hits();
    void make_tables_of_hits(StageClock& clock);
    template <typename Use>
    void for_some_points(Use&& use);
    bool serves(const ShadowTables& kept);
    std::vector<char> listed_lights();
    std::vector<std::optional<WantedDepths>> find_wanted(const std::vector<char>& listed,
                                                         LightRange lights, bool and_near);
    std::vector<LightRange> groups_of(const std::vector<char>& listed) const;
    void find_lit(const std::vector<char>& listed, const std::vector<LightRange>& groups,
                  StageClock& clock);
    LightRange all_lights() const { return {0, scene_.scene().lights.size()}; }

    SerialTree& serial_;
    const FastScene& scene_;
    FastOptions options_;
    FastTimes* times_;
    KeptTables& kept_;
    ShadowListing listing_;
    std::unique_ptr<Tables> tables_;
    std::vector<std::unique_ptr<Worker>> workers_;  // made by their threads
};

}  // namespace nuvo
