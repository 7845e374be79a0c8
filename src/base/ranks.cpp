#include "base/ranks.h"

#include <algorithm>
#include <cstdlib>

#ifdef SEARCHLIGHT_MPI
#include <mpi.h>
#endif

namespace searchlight {

#ifdef SEARCHLIGHT_MPI

namespace {

int this_rank = 0, ranks = 1;

// MPI_Init starts daemons of its own for a process that nobody launched, and takes a while for it.
bool launched() {
    for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"})
        if (std::getenv(variable)) return true;
    return false;
}

}  // namespace

Ranks::Ranks(int& argc, char**& argv) {
    if (!launched()) return;
    int provided = 0;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &this_rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
}

Ranks::~Ranks() {
    if (launched()) MPI_Finalize();
}

void Ranks::abort(int exit_code) {
    if (launched() && ranks > 1) MPI_Abort(MPI_COMM_WORLD, exit_code);
    std::exit(exit_code);
}

int rank() { return this_rank; }
int rankCount() { return ranks; }

std::vector<std::vector<double>> gatherAll(const std::vector<double>& mine) {
    if (ranks == 1) return {mine};
    // Broadcast by turns: sums of large tallies are too long for the displacements of MPI_Allgatherv.
    std::vector<std::vector<double>> all(static_cast<std::size_t>(ranks));
    for (int from = 0; from < ranks; ++from) {
        std::vector<double>& values = all[static_cast<std::size_t>(from)];
        unsigned long long size = mine.size();
        MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG_LONG, from, MPI_COMM_WORLD);
        if (from == this_rank) values = mine;
        values.resize(size);
        constexpr std::size_t most = std::size_t{1} << 26;  // counts of MPI are int
        for (std::size_t begin = 0; begin < size; begin += most)
            MPI_Bcast(values.data() + begin, static_cast<int>(std::min<std::size_t>(most, size - begin)), MPI_DOUBLE,
                      from, MPI_COMM_WORLD);
    }
    return all;
}

#else

Ranks::Ranks(int&, char**&) {}
Ranks::~Ranks() = default;
void Ranks::abort(int exit_code) { std::exit(exit_code); }
int rank() { return 0; }
int rankCount() { return 1; }
std::vector<std::vector<double>> gatherAll(const std::vector<double>& mine) { return {mine}; }

#endif

}  // namespace searchlight
