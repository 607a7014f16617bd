#pragma once

#include <array>
#include <vector>

#include "fast/shading/shading_tables.h"
#include "fast/tile/exact_fallback.h"
#include "fast/tile/open_pixels.h"
#include "fast/tile/tile.h"
#include "nuvo/image/image.h"

// Shading 16 pixels at a time in float, with a running bound on the error of each pixel. Where the
// bound does not settle all three bytes, the fallback computes the pixel as the serial tracer does.

namespace nuvo {

/// What the stages of one tile's shading tell each other.
struct alignas(64) ShadingScratch {
    SurfaceWord word[kTileLanes];    ///< unless all are the same
    TileMask lit_material;           ///< lanes that lights may light
    TileMask smooth;                 ///< whose normal is in Tile::normal: not a flat triangle's
    TileMask colored;                ///< whose color is interpolated
    float normal_error[kTileLanes];  ///< of smooth lanes
    float view[3][kTileLanes];       ///< unit, to the viewer; if something is specular
    float color[3][kTileLanes];      ///< of colored lanes, times 255

    // The light that is being sampled: its diffuse and ambient part and its specular part, without
    // colors (but see ShadingLight::gain).
    float shine[kTileLanes];
    float shine_error[kTileLanes];
    float lobe[kTileLanes];
    float lobe_error[kTileLanes];

    // Sums over the lights; errors of the largest channel.
    float diffuse[3][kTileLanes];
    float diffuse_error[kTileLanes];
    float specular[3][kTileLanes];
    float specular_error[kTileLanes];
};

/// The functions of one instruction set (shading_surface.cpp, shading_light.cpp,
/// shading_finish.cpp).
struct ShadingKernels {
    void (*surface)(const ShadingTables&, Tile&, ShadingScratch&);
    void (*sample)(const ShadingTables&, const Tile&, std::size_t light, ShadingScratch&,
                   TileMask& wanted);
    void (*add)(const ShadingTables&, std::size_t light, const TileMask& lit, ShadingScratch&);
    /// False: nothing is uncertain.
    bool (*finish)(const ShadingTables&, const Tile&, const ShadingScratch&, Image&,
                   TileMask& uncertain);
};
void pick_surface_kernel(InstructionSet isa, ShadingKernels& kernels);
void pick_light_kernels(InstructionSet isa, ShadingKernels& kernels);
void pick_finish_kernel(InstructionSet isa, ShadingKernels& kernels);

/// Turns the hits of a tile into bytes of the picture, light by light:
///   surface(tile);
///   for each light: sample(tile, light, wanted), find which wanted lanes are unblocked, add(...);
///   finish(tile, fallback, image);
/// after the last tile decide_open(fallback, image).
/// For one thread.
class ShadingStage {
  public:
    /// With tables that outlive it and are filled before anything is asked. `redo_exactly` false:
    /// bytes that are not certain stay as they are.
    explicit ShadingStage(const ShadingTables& tables, bool redo_exactly = true);

    /// Points and normals: Tile::point and point_error (which bounds the distance, too) of every
    /// lane that hits something; Tile::normal of quadrics and interpolated normals, and
    /// where something is specular of all; NaN where floats cannot tell.
    void surface(Tile& tile);
    /// Which lanes the light lights if nothing hides it. What it leaves out is surely lit with
    /// exactly zero, or not at all.
    void sample(const Tile& tile, std::size_t light, TileMask& wanted);
    /// Adds the light to the lanes of `lit`, a part of the `wanted` of the last sample(). Lights
    /// that are not asked for add nothing.
    void add(std::size_t light, const TileMask& lit);
    /// Returns the number of pixels that are left to the fallback.
    int finish(const Tile& tile, const ExactFallback& fallback, Image& image);
    /// After the last tile: lets the fallback decide the pixels that are left.
    void decide_open(const ExactFallback& fallback, Image& image) { open_.decide(fallback, image); }

  private:
    const ShadingTables* tables_;
    ShadingKernels kernels_;
    bool redo_exactly_;
    std::vector<TileMask> lit_;  // by light
    OpenPixels open_;
    ShadingScratch scratch_;
};

}  // namespace nuvo
