#include <atomic>
#include <bit>
#include <numeric>

#include "fast/frame/frame.h"
#include "fast/frame/frame_worker.h"
#include "fast/light/wanted_depths.h"

// For which lights and points shadow tables are made once it is known what the pixels show.

namespace nuvo {
namespace {

std::size_t lane_count(const TileMask& lanes) {
    std::size_t count = 0;
    for (const std::uint16_t block : lanes) count += static_cast<std::size_t>(std::popcount(block));
    return count;
}

}  // namespace

void Frame::make_tables_of_hits(StageClock& clock) {
    const TriangleSet& seen = tables_->hits.seen;
    tables_->surfaces.fill(seen, options_.threads);
    const Camera& camera = scene_.scene().camera;
    const Resolution size = tables_->rays.resolution;
    tables_->shadow = kept_.shadows();
    const bool is_first = tables_->shadow == nullptr;
    if (!is_first && listing_ != ShadowListing::kWanted && listing_ != ShadowListing::kByLight) {
        if (kept_.serve_all_of(camera, size)) return;
        if (serves(*tables_->shadow)) {
            tables_->new_points = true;
            return;
        }
    }
    const std::vector<char> listed = listed_lights();
    const std::vector<LightRange> groups = groups_of(listed);
    if (groups.size() > 1) return find_lit(listed, groups, clock);
    tables_->shadow = &kept_.keep_shadows(camera, size, [&] {
        return ShadowTables(scene_, options_.isa, options_.threads,
                            find_wanted(listed, all_lights(), !is_first));
    });
}

// All lights, if there is room for their tables at once; else parts of them, none with more than
// kGroupBytes of tables if it has several lights.
std::vector<LightRange> Frame::groups_of(const std::vector<char>& listed) const {
    const std::vector<Light>& lights = scene_.scene().lights;
    std::vector<std::size_t> bytes;
    for (std::size_t light = 0; light < lights.size(); ++light)
        bytes.push_back(lights[light].casts_shadow ? shadow_bytes(scene_, listed[light] != 0) : 0);
    const bool by_light = listing_ == ShadowListing::kByLight;
    const std::size_t all = std::accumulate(bytes.begin(), bytes.end(), std::size_t{0});
    if (!by_light && all <= most_shadow_bytes(scene_)) return {all_lights()};
    // Such tables are gone after their group, so that memory that they have used serves again.
    constexpr std::size_t kGroupBytes = std::size_t{1} << 28;
    const std::size_t most = by_light ? 0 : kGroupBytes;
    std::vector<LightRange> groups{{0, 0}};
    std::size_t of_group = 0;
    for (std::size_t light = 0; light < lights.size(); ++light) {
        if (of_group > 0 && of_group + bytes[light] > most) {
            groups.push_back({light, light});
            of_group = 0;
        }
        of_group += bytes[light];
        groups.back().last = light + 1;
    }
    return groups;
}

// By tables of one group of lights after the other, which serve no other picture.
void Frame::find_lit(const std::vector<char>& listed, const std::vector<LightRange>& groups,
                     StageClock& clock) {
    kept_.forget_shadows();
    tables_->lit = LitPixels(tables_->tiles.size(), listed.size());
    const Resolution size = tables_->rays.resolution;
    begin(options_.progress, "pixels of shadows", groups.size() * pixel_count(size));
    for (const LightRange& lights : groups) {
        if (tables_->is_serial) break;
        const ShadowTables shadow(scene_, options_.isa, options_.threads,
                                  find_wanted(listed, lights, false), lights);
        tables_->most_bytes = std::max(tables_->most_bytes, shadow.memory_bytes());
        tables_->shadow = &shadow;
        if (times_ != nullptr) clock.add_to(times_->tables);
        for_each_tile([&](Worker& worker, std::size_t i) {
            worker.find_lit(i, lights);
            add(options_.progress, tables_->pixels(i));
        });
        for (const std::unique_ptr<Worker>& worker : workers_)
            if (worker) worker->forget_shadows();
        clock.skip();
    }
    tables_->shadow = nullptr;
}

// Calls use(light, tile, wanted lanes) as Worker::want() does, for one of 16 tiles.
template <typename Use>
void Frame::for_some_points(Use&& use) {
    constexpr std::size_t kStep = 16;
    for_each_tile([&](Worker& worker, std::size_t i) {
        if (i % kStep == 0) worker.want(i, all_lights(), use);
    });
}

// By light: whether its shadows are listed for the points that it may reach. Where the picture
// shows much, most may hide something from lights that reach much of it.
std::vector<char> Frame::listed_lights() {
    constexpr std::size_t kMostSeen = 4;  // of all triangles
    constexpr std::size_t kMostLit = 8;   // of the points seen
    const std::size_t lights = scene_.scene().lights.size();
    if (listing_ != ShadowListing::kMeasured ||
        tables_->hits.seen.size() * kMostSeen <= scene_.slot_end())
        return std::vector<char>(lights, 1);
    std::vector<std::atomic<std::size_t>> seen(lights);
    std::vector<std::atomic<std::size_t>> lit(lights);
    for_some_points([&](std::size_t light, const Tile& tile, const TileMask& wanted) {
        seen[light] += lane_count(tile.hit);
        lit[light] += lane_count(wanted);
    });
    std::vector<char> listed(lights);
    for (std::size_t light = 0; light < lights; ++light)
        listed[light] = lit[light] * kMostLit <= seen[light] ? 1 : 0;
    return listed;
}

// Whether kept tables list enough for all but a few points, as far as some tiles tell; the few walk
// the octree.
bool Frame::serves(const ShadowTables& kept) {
    if (listing_ == ShadowListing::kKept || kept.complete()) return true;
    constexpr std::size_t kMost = 128;  // points to one that is not served
    std::atomic<std::size_t> asked = 0;
    std::atomic<std::size_t> served = 0;
    for_some_points([&](std::size_t light, const Tile& tile, TileMask& lanes) {
        asked += lane_count(lanes);
        if (kept.table(light).wanted) kept.table(light).wanted->keep_covered(tile, lanes);
        served += lane_count(lanes);
    });
    return (asked - served) * kMost <= asked;
}

// Of lights that are listed, where they tell places, how deep the points are that this picture
// shows; `and_near`: and those near them.
std::vector<std::optional<WantedDepths>> Frame::find_wanted(const std::vector<char>& listed,
                                                            LightRange lights, bool and_near) {
    std::vector<std::optional<WantedDepths>> all(listed.size());
    for (std::size_t i = 0; i < listed.size(); ++i) {
        const Light& light = scene_.scene().lights[i];
        if (light.casts_shadow && lights.has(i) && listed[i] != 0)
            all[i] = WantedDepths::of(scene_, LightPoint(light, scene_.frame()), options_.isa);
    }
    if (std::none_of(all.begin(), all.end(), [](const auto& depths) { return depths.has_value(); }))
        return all;
    for_each_tile([&](Worker& worker, std::size_t i) {
        worker.want(i, lights, [&](std::size_t light, const Tile& tile, const TileMask& wanted) {
            if (all[light]) all[light]->add(tile, wanted);
        });
    });
    for (std::optional<WantedDepths>& depths : all) {
        if (!depths) continue;
        if (and_near) depths->widen();
        depths->finish();
    }
    return all;
}

}  // namespace nuvo
