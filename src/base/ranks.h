// The processes of one job: this one alone, or those that mpirun started together. Each computes a part and learns the
// others', so that all go on from the same numbers; the one with rank 0 speaks and writes.
#pragma once

#include <optional>
#include <vector>

namespace searchlight {

class Ranks {
public:
    /// Joins the processes that were started with this one, if any and if MPI was built in. One at a time, in main().
    Ranks(int& argc, char**& argv);
    ~Ranks();
    Ranks(const Ranks&) = delete;
    Ranks& operator=(const Ranks&) = delete;

    /// Who failed, and whether all came to an end.
    struct Ends {
        std::optional<int> failed;  ///< the lowest rank of those whose exit code is not 0
        bool all_ended = true;      ///< false: others may be waiting for this one, which failed
    };

    /// Called once by every process, at its end. One that succeeded waits for the others; one that failed, two seconds.
    Ends meet(int exit_code);

    /// Ends all processes of the job, wherever they are.
    [[noreturn]] void abort(int exit_code);
};

/// Which of rankCount() processes this is; 0 of 1 without Ranks.
int rank();
int rankCount();

/// The numbers of rank 0, whatever the others give. All ranks call this together.
std::vector<double> shareFromFirst(const std::vector<double>& mine);

/// Everybody's numbers, in the order of ranks. All ranks call this together; each gets the same.
std::vector<std::vector<double>> gatherAll(const std::vector<double>& mine);

}  // namespace searchlight
