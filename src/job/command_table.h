// The run functions behind the rows of commands.cpp.
#pragma once

#include "job/command.h"

namespace searchlight {

JobResult runModels(const Job& job, Engine& engine, Observer& observer);
JobResult runMaterials(const Job& job, Engine& engine, Observer& observer);
JobResult runProfile(const Job& job, Engine& engine, Observer& observer);
JobResult runInvert(const Job& job, Engine& engine, Observer& observer);
JobResult runReferenceHalfSpace(const Job& job, Engine& engine, Observer& observer);
JobResult runReferenceSlab(const Job& job, Engine& engine, Observer& observer);
JobResult runMcml(const Job& job, Engine& engine, Observer& observer);
JobResult runPlotPencil(const Job& job, Engine& engine, Observer& observer);
JobResult runPlotError(const Job& job, Engine& engine, Observer& observer);
JobResult runPlotAlbedo(const Job& job, Engine& engine, Observer& observer);
JobResult runCheck(const Job& job, Engine& engine, Observer& observer);
JobResult runReport(const Job& job, Engine& engine, Observer& observer);
JobResult runDoctor(const Job& job, Engine& engine, Observer& observer);

}  // namespace searchlight
