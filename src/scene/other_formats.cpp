#include "other_formats.h"

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
};

}  // namespace

void refuse_other_formats(std::string_view text, const std::string& file) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    const std::size_t begin = text.find_first_not_of(" \t\r\n");
    text.remove_prefix(begin == std::string_view::npos ? text.size() : begin);
    for (const Format& format : kFormats)
        if (text.starts_with(format.beginning))
            throw Error(file + ": is " + format.name + ", not X3D in XML: " + format.advice);
}

}  // namespace nuvo::x3d
