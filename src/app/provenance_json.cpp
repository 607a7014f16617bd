#include <sys/utsname.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <thread>

#include "nuvo/app/build_info.h"
#include "options_json.h"

namespace nuvo::app {
namespace {

std::string processor() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.starts_with("model name") && line.find(": ") != std::string::npos)
            return line.substr(line.find(": ") + 2);
    return "unknown";
}

std::string system_name() {
    utsname name{};
    if (::uname(&name) != 0) return "unknown";
    return std::string(name.sysname) + " " + name.release + " " + name.machine;
}

std::string date_utc() {
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    std::array<char, 32> text{};
    ::gmtime_r(&now, &parts);
    std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text.data();
}

void write_names(JsonWriter& json, const char* name, const std::vector<std::string>& values) {
    json.key(name);
    json.begin_array();
    for (const std::string& value : values) json.value(value);
    json.end_array();
}

}  // namespace

void write_provenance(JsonWriter& json, const Options& options) {
    const BuildInfo info = build_info();
    json.key("provenance");
    json.begin_object();
    json.member("version", info.version);
    json.member("commit", info.commit);
    json.member("compiler", info.compiler);
    json.member("flags", info.flags);
    json.member("build_type", info.build_type);
    write_names(json, "isa", info.instruction_sets);
    json.member("processor", processor());
    json.member("cores", std::thread::hardware_concurrency());
    json.member("system", system_name());
    std::array<double, 1> load{};
    json.key("load");
    if (::getloadavg(load.data(), 1) == 1)
        json.value(load[0]);
    else
        json.null();
    json.member("date", date_utc());
    write_names(json, "arguments", options.arguments);
    json.key("libraries");
    json.begin_object();
    for (const auto& [name, version] : info.libraries) json.member(name, version);
    json.end_object();
    json.end_object();
}

}  // namespace nuvo::app
