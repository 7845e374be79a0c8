#include "gui/view/save_picture.h"

#include <fmt/format.h>

#include <QFileInfo>

#include "base/version.h"
#include "io/image_file.h"

namespace searchlight::gui {

void writePicture(Desk& desk, const ViewPicture& shown, const QString& path, QObject* receiver) {
    const State& state = desk.workspace.state();
    ToneMap tone_map;
    tone_map.exposure = shown.exposure;
    const auto option = [&](const char* name) { return optionOf(state, "view", name); };
    tone_map.curve = std::get<std::string>(option("curve")) == "filmic" ? ToneMap::Curve::filmic : ToneMap::Curve::srgb;
    tone_map.gamma = std::get<double>(option("gamma"));
    Job job = renderJob(state);
    job.window.clear();
    const TaskSpec spec{
        .lane = "files", .key = path.toStdString(), .title = QObject::tr("Saving"), .receiver = receiver};
    const auto work = [&desk, job, tone_map, image = shown.linear_a, path](TaskContext& context) {
        ImageFile file;
        file.image = *image;
        file.metadata = {{"version", std::string(version())},
                         {"job", jobJson(job)},
                         {"seed", fmt::format("{}", job.seed)},
                         {"model", job.scene.model.id}};
        writeImage(path.toStdString(), file, tone_map);
        context.publish([&desk, path] {
            desk.notices.post(Notices::Level::info, QObject::tr("Saved %1").arg(QFileInfo(path).fileName()));
        });
    };
    desk.tasks.start(spec, work, [&desk](const Error& error) { desk.notices.post(error); });
}

}  // namespace searchlight::gui
