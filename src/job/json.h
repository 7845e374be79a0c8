// Small JSON vocabulary of the commands. Only .cpp files of src/job include this.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "base/estimate.h"
#include "base/param.h"
#include "job/job.h"
#include "job/plot/subject.h"

namespace searchlight {

using Json = nlohmann::ordered_json;

/// The text of a document; with an indent of -1 in one line. Bytes of names that are no UTF-8 are replaced.
std::string jsonText(const Json& json, int indent = 1);

/// Lets `write` write a file. Where that fails, `result` tells so beside what was computed.
void writeOutput(JobResult& result, const std::function<void()>& write);

/// result.json into the job's output, if it has one.
void writeDocument(JobResult& result, const Job& job);

/// A new document: format, program version and the job that made it.
Json documentJson(std::string_view format, const Job& job);

/// [channel][i]; a channel that does not scatter is a row of nulls.
Json channelRows(std::span<const Rgb> values, const Medium& medium);

/// [channel]; null for a channel that does not scatter.
Json channelList(const Rgb& value, const Medium& medium);

/// sigma_a, sigma_s, g per channel, eta; name and source where known.
Json subjectJson(const Subject& subject);

Json paramJson(const Param& param);
Json valueJson(const ParamValue& value);

}  // namespace searchlight
