// Small JSON vocabulary of the commands. Only .cpp files of src/job include this.
#pragma once

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
