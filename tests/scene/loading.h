#pragma once

#include <gtest/gtest.h>

#include <string>
#include <variant>

#include "nuvo/scene/x3d.h"

namespace nuvo {

/// A bare Scene around `nodes`.
inline std::string bare(const std::string& nodes) { return "<Scene>" + nodes + "</Scene>"; }

/// An X3D document of the given version around `nodes`.
inline std::string versioned(const std::string& version, const std::string& nodes) {
    return "<X3D version='" + version + "'><Scene>" + nodes + "</Scene></X3D>";
}

/// A Shape with a Material and the given geometry.
inline std::string shape(const std::string& geometry) {
    return "<Shape><Appearance><Material/></Appearance>" + geometry + "</Shape>";
}

inline Scene load(const std::string& text, x3d::Headlight headlight = x3d::Headlight::kAuto,
                  const x3d::Limits& limits = {}) {
    return x3d::read_text(text, "scene.x3d", {limits, headlight});
}

/// The message with which `text` is refused where reading is strict; empty when it is not.
inline std::string refusal(const std::string& text, const x3d::Limits& limits = {}) {
    try {
        x3d::read_text(text, "scene.x3d", {.limits = limits, .strict = true});
    } catch (const x3d::Error& error) {
        return error.what();
    }
    return "";
}

inline std::string repeated(const std::string& text, std::size_t count) {
    std::string all;
    for (std::size_t i = 0; i < count; ++i) all += text;
    return all;
}

inline void expect_near(const Vector3& actual, const Vector3& expected, double tolerance = 1e-14) {
    EXPECT_NEAR(actual.x, expected.x, tolerance);
    EXPECT_NEAR(actual.y, expected.y, tolerance);
    EXPECT_NEAR(actual.z, expected.z, tolerance);
}

inline const TriangleMesh& mesh_of(const Scene& scene, std::size_t object = 0) {
    return std::get<TriangleMesh>(scene.objects.at(object).shape);
}

}  // namespace nuvo
