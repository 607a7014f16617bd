#pragma once

#include <string>
#include <string_view>

namespace nuvo::x3d {

/// Throws Error for a file that holds a scene in another form than XML, with the program that turns
/// it into XML; `file` stands for it in messages.
void refuse_other_formats(std::string_view text, const std::string& file);

}  // namespace nuvo::x3d
