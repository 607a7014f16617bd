#include "nuvo/scene/x3d.h"

#include "documents.h"
#include "scene_reader.h"

namespace nuvo::x3d {

Scene read_file(const std::filesystem::path& path, Headlight headlight, const Limits& limits,
                const std::string& viewpoint) {
    Messages messages;
    Documents documents(limits, messages);
    const Document& document = documents.read_file(path);
    return SceneReader(documents, limits, messages).read(document, headlight, viewpoint);
}

Scene read_text(const std::string& text, const std::string& name, Headlight headlight,
                const Limits& limits, const std::string& viewpoint) {
    Messages messages;
    Documents documents(limits, messages);
    const Document& document = documents.read_text(text, name);
    return SceneReader(documents, limits, messages).read(document, headlight, viewpoint);
}

}  // namespace nuvo::x3d
