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

void interrupt(int signal) {
    // A second Ctrl+C does not wait for the work to notice. That mpirun passes one on as SIGTERM is not a second one.
    static std::atomic<int> before = 0;
    interrupted = true;
    if (before.exchange(signal) == signal) _exit(130);
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
    const auto speak = [](std::string_view text) {
        if (rank() == 0) print(text);
    };
    if (!arguments.job) {
        speak(arguments.text);
        return 0;
    }
    if (arguments.print_job) {
        speak(jobJson(*arguments.job) + "\n");
        return 0;
    }
    if (arguments.watch && rankCount() > 1) throw usageError("--watch is for one process", "leave mpirun out");
    TerminalObserver observer(interrupted);
    Engine engine;
    const auto runOnce = [&] {
        const JobResult result = run(*arguments.job, engine, observer);
        observer.finish();
        speak(arguments.json ? result.json + "\n" : result.text);
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
    int code = 0;
    std::string message;
    try {
        code = runArguments(argc, argv);
    } catch (const Error& error) {
        code = exitCode(error.kind);
        message = error.what();
    } catch (const std::bad_alloc&) {
        code = exitCode(ErrorKind::input);
        message = "out of memory";
    } catch (const std::exception& error) {
        code = exitCode(ErrorKind::input);
        message = error.what();
    }
    // What is wrong for all, one says.
    const Ranks::Ends ends = ranks.meet(code);
    if (!message.empty() && ends.failed == rank())
        fmt::print(stderr, "searchlight: {}{}\n",
                   rank() > 0 ? fmt::format("process {} of {}: ", rank() + 1, rankCount()) : "", message);
    if (!ends.all_ended) ranks.abort(code);
    return code;
}
