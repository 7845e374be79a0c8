// searchlight: the command line. Builds a Job from the arguments, runs it, shows what comes back.
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <thread>

#include "arguments.h"
#include "base/error.h"
#include "base/ranks.h"
#include "job/engine.h"
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

// Runs again whenever a model file of the job changes; a mistake in one is shown, and mended by the next save.
int watch(const Job& job, const std::function<int()>& runOnce) {
    namespace fs = std::filesystem;
    const std::vector<std::string> files = modelFiles(job);
    if (files.empty()) throw usageError("--watch needs a model file", "such as --models dipole,./my.bssrdf");
    const auto stamps = [&] {
        std::vector<fs::file_time_type> times;
        std::error_code missing;  // an editor may be between deleting and writing
        for (const std::string& file : files) times.push_back(fs::last_write_time(file, missing));
        return times;
    };
    while (!interrupted) {
        const auto seen = stamps();
        try {
            runOnce();
            fmt::print(stderr, "watching {}\n", fmt::join(files, ", "));
        } catch (const Error& error) {
            if (error.kind == ErrorKind::interrupted) break;
            fmt::print(stderr, "searchlight: {}\n", error.what());
        }
        while (!interrupted && stamps() == seen) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return 0;
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
    Engine engine;
    const auto runOnce = [&] {
        const JobResult result = run(*arguments.job, engine, observer);
        observer.finish();
        if (rank() == 0) print(arguments.json ? result.json + "\n" : result.text);
        if (!result.failure.empty()) throw inputError(result.failure);
        if (result.interrupted) return exitCode(ErrorKind::interrupted);
        return result.passed ? 0 : 1;
    };
    return arguments.watch ? watch(*arguments.job, runOnce) : runOnce();
}

}  // namespace

int main(int argc, char** argv) {
    struct sigaction action = {};
    action.sa_handler = interrupt;  // without SA_RESTART: a pipe that nobody writes is not waited for again
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
    Ranks ranks(argc, argv);
    const auto fail = [&](int code, std::string_view message) {
        fmt::print(stderr, "searchlight: {}\n", message);
        if (rankCount() > 1) ranks.abort(code);
        return code;
    };
    try {
        return runArguments(argc, argv);
    } catch (const Error& error) {
        return fail(exitCode(error.kind), error.what());
    } catch (const std::bad_alloc&) {
        return fail(exitCode(ErrorKind::input), "out of memory");
    } catch (const std::exception& error) {
        return fail(exitCode(ErrorKind::input), error.what());
    }
}
