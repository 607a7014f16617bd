#include "other_formats.h"

#include <algorithm>
#include <cstdint>

#include "nuvo/scene/x3d.h"

namespace nuvo::x3d {

namespace {

struct Format {
    std::string_view beginning;
    const char* name;
    const char* advice;
};

constexpr const char* kConverter = "convert it by tovrmlx3d --encoding xml";
constexpr const char* kSaveAsX3d = "save it as X3D";
constexpr const char* kNameTheScene = "name the scene's file";

constexpr Format kFormats[] = {
    {"#VRML V1.0", "VRML 1.0", kConverter},
    {"#VRML V2.0", "VRML 97", kConverter},
    {"#VRML", "VRML", kConverter},
    {"#X3D V", "X3D in the classic VRML encoding", kConverter},
    {"#Inventor", "Open Inventor", kConverter},
    {"{", "JSON", "convert X3D's JSON encoding by x3d-tidy"},
    {std::string_view("\xe0\x00\x00\x01", 4), "X3D in the binary encoding",
     "convert it by x3d-tidy"},
    {"glTF", "binary glTF", kSaveAsX3d},
    {"PK\x03\x04", "a zip archive", "unpack it"},
    {"<!DOCTYPE html", "an html page", "save its X3D element as a file of its own"},
    {"<!doctype html", "an html page", "save its X3D element as a file of its own"},
    {"<html", "an html page", "save its X3D element as a file of its own"},
    {"<COLLADA", "COLLADA", kSaveAsX3d},
    {"solid ", "STL", kSaveAsX3d},
    {"ply\n", "PLY", kSaveAsX3d},
    {"ply\r", "PLY", kSaveAsX3d},
    {"mtllib ", "OBJ", kSaveAsX3d},
    {"o ", "OBJ", kSaveAsX3d},
    {"v ", "OBJ", kSaveAsX3d},
    {"ISO-10303-21;", "STEP", kSaveAsX3d},
    {"\x89PNG", "a PNG picture", kNameTheScene},
    {"\xff\xd8\xff", "a JPEG picture", kNameTheScene},
    {"BM", "a BMP picture", kNameTheScene},
};

/// A binary STL: 80 bytes of any content, the number of triangles, 50 bytes for each.
bool is_binary_stl(std::string_view text) {
    constexpr std::size_t kHeader = 84, kTriangle = 50;
    if (text.size() < kHeader + kTriangle) return false;
    std::uint32_t count = 0;
    for (const std::size_t i : {83U, 82U, 81U, 80U})
        count = count << 8 | static_cast<unsigned char>(text[i]);
    return (text.size() - kHeader) % kTriangle == 0 && (text.size() - kHeader) / kTriangle == count;
}

}  // namespace

void refuse_other_formats(std::string_view text, const std::string& file) {
    const auto refuse = [&file](const char* name, const char* advice) {
        throw Error(file + ": is " + name + ", not X3D in XML: " + advice);
    };
    if (is_binary_stl(text)) refuse("binary STL", kSaveAsX3d);
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    while (true) {
        text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
        for (const Format& format : kFormats)
            if (text.starts_with(format.beginning)) refuse(format.name, format.advice);
        if (!text.starts_with('#')) return;  // else an OBJ's comment
        text.remove_prefix(std::min(text.find('\n'), text.size()));
    }
}

}  // namespace nuvo::x3d
