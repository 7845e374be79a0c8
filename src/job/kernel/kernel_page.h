// kernels.html: every method on one material.
#pragma once

#include <string>
#include <vector>

#include "draw/report.h"
#include "job/kernel/kernel_judged.h"
#include "job/kernel/kernel_truth.h"

namespace searchlight {

/// Tables of errors, curves of the best ones, pictures and differences.
Report kernelPage(const Subject& subject, const KernelTruth& truth, const Judge& judge,
                  const std::vector<JudgedKernel>& kernels);

}  // namespace searchlight
