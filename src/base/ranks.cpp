#include "base/ranks.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

#ifdef SEARCHLIGHT_MPI
#include <mpi.h>
#endif

namespace searchlight {

#ifdef SEARCHLIGHT_MPI

namespace {

using namespace std::chrono_literals;

// Processes that fail alike (a wrong argument, a missing file) do so within milliseconds of each other.
constexpr std::chrono::milliseconds kPatience = 2s, kPause = 1ms;

int this_rank = 0, ranks = 1;
// How processes end is told beside what they compute: some may be in the middle of that.
MPI_Comm at_the_end = MPI_COMM_NULL;

// MPI_Init starts daemons of its own for a process that nobody launched, and takes a while for it.
bool launched() {
    for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"})
        if (std::getenv(variable)) return true;
    return false;
}

void broadcast(std::vector<double>& values, int from) {
    unsigned long long size = values.size();
    MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG_LONG, from, MPI_COMM_WORLD);
    values.resize(size);
    constexpr std::size_t most = std::size_t{1} << 26;  // counts of MPI are int
    for (std::size_t begin = 0; begin < size; begin += most)
        MPI_Bcast(values.data() + begin, static_cast<int>(std::min<std::size_t>(most, size - begin)), MPI_DOUBLE, from,
                  MPI_COMM_WORLD);
}

}  // namespace

Ranks::Ranks(int& argc, char**& argv) {
    if (!launched()) return;
    int provided = 0;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &this_rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    MPI_Comm_dup(MPI_COMM_WORLD, &at_the_end);
}

Ranks::~Ranks() {
    if (launched()) MPI_Finalize();
}

Ranks::Ends Ranks::meet(int exit_code) {
    const auto own = exit_code != 0 ? std::optional(this_rank) : std::nullopt;
    if (ranks == 1) return {own};
    const int mine = exit_code != 0 ? this_rank : ranks;
    int lowest = ranks, done = 0;
    MPI_Request request;
    MPI_Iallreduce(&mine, &lowest, 1, MPI_INT, MPI_MIN, at_the_end, &request);
    const auto until = std::chrono::steady_clock::now() + kPatience;
    for (MPI_Test(&request, &done, MPI_STATUS_IGNORE); !done; MPI_Test(&request, &done, MPI_STATUS_IGNORE)) {
        if (own && std::chrono::steady_clock::now() > until) return {own, false};
        std::this_thread::sleep_for(kPause);
    }
    return {lowest < ranks ? std::optional(lowest) : std::nullopt};
}

void Ranks::abort(int exit_code) {
    if (launched() && ranks > 1) MPI_Abort(MPI_COMM_WORLD, exit_code);
    std::exit(exit_code);
}

int rank() { return this_rank; }
int rankCount() { return ranks; }

std::vector<double> shareFromFirst(const std::vector<double>& mine) {
    std::vector<double> values;
    if (this_rank == 0) values = mine;
    if (ranks > 1) broadcast(values, 0);
    return values;
}

std::vector<std::vector<double>> gatherAll(const std::vector<double>& mine) {
    if (ranks == 1) return {mine};
    // Broadcast by turns: sums of large tallies are too long for the displacements of MPI_Allgatherv.
    std::vector<std::vector<double>> all(static_cast<std::size_t>(ranks));
    all[static_cast<std::size_t>(this_rank)] = mine;
    for (int from = 0; from < ranks; ++from) broadcast(all[static_cast<std::size_t>(from)], from);
    return all;
}

#else

Ranks::Ranks(int&, char**&) {}
Ranks::~Ranks() = default;
Ranks::Ends Ranks::meet(int exit_code) { return {exit_code != 0 ? std::optional(0) : std::nullopt}; }
void Ranks::abort(int exit_code) { std::exit(exit_code); }
int rank() { return 0; }
int rankCount() { return 1; }
std::vector<double> shareFromFirst(const std::vector<double>& mine) { return mine; }
std::vector<std::vector<double>> gatherAll(const std::vector<double>& mine) { return {mine}; }

#endif

}  // namespace searchlight
