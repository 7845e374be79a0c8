// Job files are not trusted: whatever the bytes, the answer is a job or an Error; a job that was read is written and
// read back unchanged.
#include <cstdint>
#include <cstdlib>

#include "base/error.h"
#include "job/job.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace searchlight;
    try {
        const Job job = parseJob({reinterpret_cast<const char*>(data), size}, "fuzz");
        const std::string text = jobJson(job);
        if (jobJson(parseJob(text, "fuzz")) != text) std::abort();
    } catch (const Error&) {
    }
    return 0;
}
