// Writes the manual page or the completion of the shell from the table of flags:
// nuvo_pages man|bash.

#include <iostream>
#include <string>
#include <string_view>
#include <vector>

#include "nuvo/app/options.h"

namespace nuvo::app {
namespace {

/// Text for troff: no dash becomes a hyphen, no backslash an escape, no line starts a request.
std::string for_troff(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '\\') {
            out += "\\e";
        } else if (c == '-') {
            out += "\\-";
        } else {
            if (out.empty() && (c == '.' || c == '\'')) out += "\\&";
            out += c;
        }
    }
    return out;
}

std::string syntax(const Flag& flag) {
    const bool has_sign = !flag.value.empty() && !flag.may_stand_alone();
    return flag.spelling + (has_sign ? "=" : "") + flag.value;
}

void write_manual(std::ostream& out) {
    out << ".TH NUVO 1 \"\" \"nuvo\" \"User Commands\"\n"
           ".SH NAME\nnuvo \\- render X3D scenes through uniform and non\\-uniform octrees\n"
           ".SH SYNOPSIS\n.B nuvo\n[\\fIflag\\fR]...\n"
           ".SH DESCRIPTION\n"
           "Reads an X3D scene, builds an octree and writes a picture. Flags begin with one dash "
           "or "
           "two and stand in any order, each at most once.\n"
           ".SH OPTIONS\n";
    for (const Flag& flag : flags()) {
        out << ".TP\n.B " << for_troff(syntax(flag)) << '\n' << for_troff(flag.help);
        if (!flag.standard.empty()) out << " [default: " << for_troff(flag.standard) << ']';
        out << '\n';
    }
    out << ".SH EXIT STATUS\n"
           "0 done, 1 pictures differ (\\-compare), 2 usage, 3 scene refused, 4 cannot write or "
           "out "
           "of memory, 128 + N ended by signal N.\n"
           ".SH EXAMPLES\n.nf\nnuvo \\-\\-file=scene.x3d \\-\\-profile=fast \\-\\-threads=0\n"
           "nuvo \\-\\-file=scene.x3d \\-compare\n.fi\n";
}

/// The words of a value's syntax, "a|b|c"; none where it is free.
std::vector<std::string> words_of(std::string value) {
    std::erase_if(value, [](char c) { return c == '[' || c == ']' || c == '='; });
    std::vector<std::string> words(1);
    for (const char c : value) {
        if (c == '|') {
            words.emplace_back();
        } else {
            words.back() += c;
        }
    }
    // Capitals stand for what the user fills in.
    std::erase_if(words, [](const std::string& word) {
        return word.empty() || word.find_first_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ") != word.npos;
    });
    return words;
}

void write_completion(std::ostream& out) {
    out << "# Completion of nuvo's flags and their values, for bash. Made from the table of "
           "flags.\n"
           "_nuvo() {\n"
           "    local word=${COMP_LINE:0:COMP_POINT} values\n"
           "    word=${word##* }\n"
           "    COMPREPLY=()\n"
           "    case $word in\n";
    std::string names;
    for (const Flag& flag : flags()) {
        std::string name = flag.spelling;
        for (std::size_t comma; (comma = name.find(", ")) != name.npos;)
            name.replace(comma, 2, " ");
        names += name + (flag.value.empty() || flag.may_stand_alone() ? " " : "= ");
        std::string values;
        for (const std::string& value : words_of(flag.value)) values += value + ' ';
        if (!values.empty())
            out << "        --" << flag.name << "=* | -" << flag.name << "=*) values='" << values
                << "' ;;\n";
    }
    out << "        -*=*) COMPREPLY=($(compgen -f -- \"${word#*=}\")); return ;;\n"
           "        -*) COMPREPLY=($(compgen -W '"
        << names
        << "' -- \"$word\"))\n"
           "            [[ ${COMPREPLY[0]-} != *= ]] || compopt -o nospace 2>/dev/null\n"
           "            return ;;\n"
           "        *) COMPREPLY=($(compgen -f -- \"$word\")); return ;;\n"
           "    esac\n"
           "    COMPREPLY=($(compgen -W \"$values\" -- \"${word#*=}\"))\n"
           "}\n"
           "complete -o filenames -F _nuvo nuvo\n";
}

}  // namespace
}  // namespace nuvo::app

int main(int argc, char** argv) {
    const std::string_view page = argc == 2 ? argv[1] : "";
    if (page == "man") {
        nuvo::app::write_manual(std::cout);
    } else if (page == "bash") {
        nuvo::app::write_completion(std::cout);
    } else {
        std::cerr << "usage: nuvo_pages man|bash\n";
        return 2;
    }
    return std::cout.flush() ? 0 : 4;
}
