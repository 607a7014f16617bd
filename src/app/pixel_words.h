#pragma once

#include <string_view>

#include "nuvo/render/explain.h"
#include "nuvo/render/profile.h"

// The words by which text, JSON and pictures call what the tracer tells.

namespace nuvo::app {

constexpr std::string_view kind_word(PrimitiveKind kind) {
    return kind == PrimitiveKind::kTriangle ? "triangle"
           : kind == PrimitiveKind::kSphere ? "sphere"
                                            : "ellipsoid";
}

constexpr std::string_view kind_word(Light::Kind kind) {
    return kind == Light::Kind::kDirectional ? "directional"
           : kind == Light::Kind::kPoint     ? "point"
                                             : "spot";
}

constexpr std::string_view stage_word(Precision precision, Stage stage) {
    if (precision == Precision::kFloat) return "float";
    if (precision == Precision::kDouble) return "double";
    return stage == Stage::kCheap ? "cheap" : stage == Stage::kWider ? "wider" : "exact";
}

constexpr std::string_view end_word(LightStory::End end) {
    switch (end) {
        case LightStory::End::kOutOfScope:
            return "out of scope";
        case LightStory::End::kTooFar:
            return "out of reach";
        case LightStory::End::kBlocked:
            return "blocked";
        case LightStory::End::kLit:
            return "lit";
    }
    return "";
}

}  // namespace nuvo::app
