#pragma once

#include "nuvo/app/json_writer.h"
#include "nuvo/app/options.h"

namespace nuvo::app {

/// The member "profile": every answer.
void write_profile(JsonWriter& json, const Options& options);
/// The member "provenance": what made the figures, from what, where and when.
void write_provenance(JsonWriter& json, const Options& options);
/// The member "resolution".
void write_resolution(JsonWriter& json, Resolution resolution);

}  // namespace nuvo::app
