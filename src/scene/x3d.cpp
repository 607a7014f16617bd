#include "nuvo/scene/x3d.h"

#include "documents.h"
#include "scene_reader.h"

namespace nuvo::x3d {

Scene read_file(const std::filesystem::path& path, const ReadOptions& options) {
    Messages messages(options.strict);
    Documents documents(options.limits, messages, options.progress);
    const Document& document = documents.read_file(path);
    return SceneReader(documents, options, messages).read(document);
}

Scene read_text(const std::string& text, const std::string& name, const ReadOptions& options) {
    Messages messages(options.strict);
    Documents documents(options.limits, messages, options.progress);
    const Document& document = documents.read_text(text, name);
    return SceneReader(documents, options, messages).read(document);
}

}  // namespace nuvo::x3d
