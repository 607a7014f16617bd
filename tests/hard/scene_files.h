#pragma once

#include <string>
#include <vector>

namespace nuvo::hard {

struct SceneFile {
    std::string name;  ///< without folder and .x3d
    std::string text;
};

/// The files of testfiles/hard. `scripts/hard.sh --write-scenes` writes them anew.
std::vector<SceneFile> hard_scene_files();

}  // namespace nuvo::hard
