// Random walks in a file between two runs of a job: "searchlight-walks/1". A job that was stopped and taken up again
// with the same number of walks ends with the numbers of one that never stopped.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "job/command.h"
#include "job/json.h"
#include "transport/walk/walk_state.h"

namespace searchlight {

class SavedWalks {
public:
    /// One state per walk of the job (a channel, a slab). `problem` is everything that the sums depend on but the
    /// number of walks. With --resume reads the file where it exists, on the machine of the process that writes it;
    /// throws an input Error when it holds another problem, naming the first difference, or cannot be read or written.
    /// `observer` outlives this.
    SavedWalks(const Options& options, const Job& job, Json problem, std::size_t states, Observer& observer);

    /// How walk `i` goes on: shared by all processes, stopped by --until-error, kept in the file.
    WalkControl control(std::size_t i);

    /// Whether an interruption leaves something: with --resume, an output, or several processes, which stop together.
    bool keeps() const { return keeps_; }

    /// Writes the file, if there is one. Where that fails, `result` tells so.
    void save(JobResult& result) const;

private:
    void read();
    void write() const;
    void share();

    std::string path_;
    Observer& observer_;
    Json problem_;
    double until_error_ = 0;
    bool keeps_ = false;
    std::vector<WalkState> states_;
};

}  // namespace searchlight
