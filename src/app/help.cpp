#include <sstream>

#include "nuvo/app/options.h"

namespace nuvo::app {
namespace {

constexpr std::size_t kTextColumn = 4;
constexpr std::size_t kLastColumn = 80;

std::string syntax(const Flag& flag) {
    const char* const sign = flag.value.empty() || flag.may_stand_alone() ? "" : "=";
    return flag.spelling + sign + flag.value;
}

void append_wrapped(std::string& out, const std::string& text) {
    std::istringstream words(text);
    std::string word;
    std::size_t column = 0;
    while (words >> word) {
        if (column != 0 && column + 1 + word.size() > kLastColumn) {
            out += '\n';
            column = 0;
        }
        out += column == 0 ? std::string(kTextColumn, ' ') : " ";
        out += word;
        column += word.size() + (column == 0 ? kTextColumn : 1);
    }
    out += '\n';
}

std::string in_table_cell(const std::string& text) {
    std::string cell;
    for (const char c : text) cell += c == '|' ? std::string("\\|") : std::string(1, c);
    return cell;
}

}  // namespace

std::string help_text() {
    std::string out =
        "nuvo: ray tracing through uniform and non-uniform octrees\n"
        "usage: nuvo [flag]... [scene]\n\n"
        "  nuvo scene.x3d --profile=fast --threads=0\n"
        "    the picture, scene.bmp, as soon as may be\n"
        "  nuvo scene.x3d --res=640x480 --samples=4 --out=small.png\n"
        "    smooth edges, as PNG\n"
        "  nuvo scene.x3d --from=3,4,5 --at=0,0,0 --fov=40 --out=view.png\n"
        "    from elsewhere\n"
        "  nuvo scene.x3d --rays=rays.txt --out=answers.txt\n"
        "    what each ray meets\n"
        "  nuvo scene.x3d --type=nonuniform --rep=5 --json=figures.json\n"
        "    the thesis' measurement, every figure kept\n"
        "  zcat scene.x3dz | nuvo - > picture.bmp\n"
        "    in a pipe\n";
    std::string group;
    for (const Flag& flag : flags()) {
        if (flag.group != group) out += "\n" + flag.group + "\n";
        group = flag.group;
        out += "  " + syntax(flag) + "\n";
        append_wrapped(
            out, flag.help + (flag.standard.empty() ? "" : " [default: " + flag.standard + "]"));
    }
    out +=
        "\nexit: 0 done, 1 pictures differ (-compare), 2 usage, 3 scene refused,\n"
        "4 cannot write or out of memory, 128 + N ended by signal N\n";
    return out;
}

std::string help_markdown() {
    std::string out = "| flag | default | meaning |\n|---|---|---|\n";
    for (const Flag& flag : flags())
        out += "| `" + in_table_cell(syntax(flag)) + "` | " +
               (flag.standard.empty() ? "" : "`" + in_table_cell(flag.standard) + "`") + " | " +
               in_table_cell(flag.help) + " |\n";
    return out;
}

}  // namespace nuvo::app
