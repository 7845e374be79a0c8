// searchlight: the command line. Builds a Job from the arguments, runs it, shows what comes back.
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <exception>
#include <optional>

#include "arguments.h"
#include "base/error.h"
#include "job/job.h"
#include "progress.h"

namespace {

using namespace searchlight;

std::atomic<bool> interrupted = false;

void interrupt(int) {
    // A second Ctrl+C does not wait for the work to notice.
    if (interrupted.exchange(true)) _exit(130);
}

int exitCode(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::usage: return 2;
        case ErrorKind::input: return 3;
        case ErrorKind::device: return 4;
        case ErrorKind::interrupted: return 130;
    }
    return 3;
}

// All of standard output, or an error: a full disk or a closed pipe must not look like success.
void print(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
        throw inputError("cannot write to standard output");
}

int runArguments(int argc, char** argv) {
    const Arguments arguments = parseArguments(argc, argv);
    if (!arguments.job) {
        print(arguments.text);
        return 0;
    }
    if (arguments.print_job) {
        print(jobJson(*arguments.job) + "\n");
        return 0;
    }
    TerminalObserver observer(interrupted);
    const JobResult result = run(*arguments.job, observer);
    observer.finish();
    print(arguments.json ? result.json + "\n" : result.text);
    return result.passed ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    std::signal(SIGINT, interrupt);
    std::signal(SIGTERM, interrupt);
    std::signal(SIGPIPE, SIG_IGN);
    try {
        return runArguments(argc, argv);
    } catch (const Error& error) {
        fmt::print(stderr, "searchlight: {}\n", error.what());
        return exitCode(error.kind);
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "searchlight: out of memory\n");
        return exitCode(ErrorKind::input);
    }
}
