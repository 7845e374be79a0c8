// The processes of one job: this one alone, or those that mpirun started together. Each computes a part and learns the
// others', so that all go on from the same numbers; the one with rank 0 speaks and writes.
#pragma once

#include <vector>

namespace searchlight {

class Ranks {
public:
    /// Joins the processes that were started with this one, if any and if MPI was built in. One at a time, in main().
    Ranks(int& argc, char**& argv);
    ~Ranks();
    Ranks(const Ranks&) = delete;
    Ranks& operator=(const Ranks&) = delete;

    /// Ends all processes of the job: one of them failed, and the others would wait for it.
    [[noreturn]] void abort(int exit_code);
};

/// Which of rankCount() processes this is; 0 of 1 without Ranks.
int rank();
int rankCount();

/// Everybody's numbers, in the order of ranks. All ranks call this together; each gets the same.
std::vector<std::vector<double>> gatherAll(const std::vector<double>& mine);

}  // namespace searchlight
