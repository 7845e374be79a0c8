#include "gui/state/open_path.h"

#include <QFileInfo>
#include <algorithm>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "io/image_file.h"
#include "io/shape_file.h"
#include "model/model.h"

namespace searchlight::gui {

namespace {

bool endsLike(const QString& path, const std::vector<std::string>& endings) {
    QString lower = path.toLower();
    if (lower.endsWith(".gz")) lower.chop(3);  // shapes may be compressed
    return std::ranges::any_of(endings,
                               [&](const std::string& e) { return lower.endsWith(QString::fromStdString(e)); });
}

QString patterns(const std::vector<std::string>& endings) {
    QStringList list;
    for (const std::string& ending : endings) list << "*" + QString::fromStdString(ending);
    return list.join(' ');
}

const std::vector<std::string>& modelEndings() {
    static const std::vector<std::string> endings{".bssrdf", ".csv"};
    return endings;
}

void addModel(Workspace& workspace, const std::string& path) {
    // A file that is no model at all is refused here; what does not compile is shown by the editor.
    if (path.ends_with(".csv")) loadModel(path);
    workspace.edit(QObject::tr("Add model"), {}, [&](State& state) {
        const auto known =
            std::ranges::find_if(state.models, [&](const ModelSlot& slot) { return slot.model.id == path; });
        state.active = static_cast<int>(known - state.models.begin());
        if (known == state.models.end()) state.models.push_back(newSlot(state, path));
    });
}

}  // namespace

FileKind kindOf(const QString& path) {
    if (path.endsWith(".json", Qt::CaseInsensitive)) return FileKind::workspace;
    if (endsLike(path, shapeEndings())) return FileKind::shape;
    if (path.endsWith(".gz", Qt::CaseInsensitive)) return FileKind::unknown;
    if (endsLike(path, modelEndings())) return FileKind::model;
    if (endsLike(path, imageEndings())) return FileKind::picture;
    return FileKind::unknown;
}

void openPath(Workspace& workspace, const QString& given) {
    const QFileInfo info(given);
    const std::string path = info.absoluteFilePath().toStdString();
    if (!info.isFile()) throw inputError("there is no such file").at(path);
    switch (kindOf(given)) {
        case FileKind::workspace: workspace.open(parseWorkspace(readFile(path), path), info.absoluteFilePath()); return;
        case FileKind::shape:
            workspace.edit(QObject::tr("Open object"), {}, [&](State& state) {
                state.scene.object = path;
                state.scene.camera.target = {};
                state.scene.camera.distance = 0;
            });
            return;
        case FileKind::picture:
            workspace.edit(QObject::tr("Light by a picture"), {}, [&](State& state) {
                state.scene.lights = {EnvironmentLight{.path = path, .occlusion = true}};
            });
            return;
        case FileKind::model: addModel(workspace, path); return;
        case FileKind::unknown: break;
    }
    throw inputError("this is no file that Searchlight opens",
                     "workspaces .json; models " + join(modelEndings(), ", ") + "; shapes " +
                         join(shapeEndings(), ", ") + "; pictures " + join(imageEndings(), ", "))
        .at(path);
}

QString openFilter() {
    std::vector<std::string> all{".json"};
    for (const auto& endings : {modelEndings(), shapeEndings(), imageEndings()})
        all.insert(all.end(), endings.begin(), endings.end());
    return QObject::tr(
               "Everything Searchlight opens (%1);;Workspaces (*.json);;Models (%2);;Objects (%3);;Pictures (%4)")
        .arg(patterns(all), patterns(modelEndings()), patterns(shapeEndings()), patterns(imageEndings()));
}

}  // namespace searchlight::gui
