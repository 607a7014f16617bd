#include "nuvo/app/program.h"

#include <unistd.h>

#include <array>
#include <csignal>
#include <cstring>
#include <iostream>
#include <new>
#include <stdexcept>

#include "nuvo/app/build_info.h"
#include "nuvo/app/commands.h"
#include "nuvo/app/options.h"
#include "nuvo/app/rays.h"
#include "nuvo/image/file_writer.h"

namespace nuvo::app {
namespace {

extern "C" void end_by_signal(int signal) {
    image::remove_pending_temporary();
    ::_exit(kSignalBase + signal);
}

void install_signal_handlers() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
        struct sigaction old {};
        // nohup's wish is respected. A shell's background jobs ignore SIGINT, too, but whoever
        // sends them one means it.
        const bool is_ignored =
            ::sigaction(signal, nullptr, &old) == 0 && old.sa_handler == SIG_IGN;
        if (signal == SIGHUP && is_ignored) continue;
        struct sigaction action {};
        action.sa_handler = end_by_signal;
        ::sigfillset(&action.sa_mask);
        ::sigaction(signal, &action, nullptr);
    }
    // A closed pipe and a file grown too large shall be errors of writing, not ends without a word.
    ::signal(SIGPIPE, SIG_IGN);
    ::signal(SIGXFSZ, SIG_IGN);
}

/// One line on standard error, whatever the message holds, without taking memory.
ExitCode fail(ExitCode code, const char* message) noexcept {
    static std::array<char, 4096> line;
    std::size_t size = 0;
    const auto append = [&size](const char* text) {
        for (; *text != '\0' && size + 1 < line.size(); ++text)
            line[size++] = static_cast<unsigned char>(*text) < ' ' ? '?' : *text;
    };
    append("nuvo: ");
    append(message);
    line[size++] = '\n';
    const ssize_t written = ::write(STDERR_FILENO, line.data(), size);
    static_cast<void>(written);  // there is nobody left to tell
    return code;
}

ExitCode obey(const Options& options) {
    if (options.help) {
        std::cout << help_text();
        return kDone;
    }
    if (options.version) {
        std::cout << version_text();
        return kDone;
    }
    if (options.describe) return describe_command(options);
    if (options.compare) return compare_command(options);
    if (options.study) return study_command(options);
    if (options.pixel) return pixel_command(options);
    if (options.rays) return rays_command(options);
    return render_command(options);
}

ExitCode obey_and_flush(const Options& options) {
    const ExitCode code = obey(options);
    if (!std::cout.flush()) throw image::WriteError("standard output: cannot write");
    return code;
}

}  // namespace

int run(int argc, char** argv) {
    install_signal_handlers();
    try {
        const std::vector<std::string> arguments(argv + (argc > 0 ? 1 : 0), argv + argc);
        return obey_and_flush(parse(arguments));
    } catch (const UsageError& error) {
        return fail(kUsage, error.what());
    } catch (const x3d::Error& error) {
        return fail(kSceneRefused, error.what());
    } catch (const RaysError& error) {
        return fail(kSceneRefused, error.what());
    } catch (const image::WriteError& error) {
        return fail(kCannotWrite, error.what());
    } catch (const std::bad_alloc&) {
        return fail(kCannotWrite, "out of memory");
    } catch (const std::length_error&) {  // a container asked for more than any memory
        return fail(kCannotWrite, "out of memory");
    } catch (const std::exception& error) {
        return fail(kCannotWrite, error.what());
    }
}

}  // namespace nuvo::app
