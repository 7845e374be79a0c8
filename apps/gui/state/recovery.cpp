#include "gui/state/recovery.h"

#include <signal.h>
#include <unistd.h>

#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <cerrno>

#include "base/error.h"
#include "base/files.h"

namespace searchlight::gui {

namespace {

constexpr int every_ms = 3000;

bool runs(qint64 process) { return process > 0 && (kill(static_cast<pid_t>(process), 0) == 0 || errno == EPERM); }

}  // namespace

Recovery::Recovery(Workspace& workspace, QString folder, QObject* parent)
    : QObject(parent), workspace_(workspace), folder_(std::move(folder)) {
    timer_.setInterval(every_ms);
    timer_.setSingleShot(true);
    connect(&timer_, &QTimer::timeout, this, &Recovery::write);
    connect(&workspace_, &Workspace::changed, this, [this] {
        dirty_ = true;
        if (!timer_.isActive()) timer_.start();
    });
}

Recovery::~Recovery() {
    if (!folder_.isEmpty()) QFile::remove(ownFile());
}

QString Recovery::userFolder() {
    const QString state = qEnvironmentVariable("XDG_STATE_HOME"), home = qEnvironmentVariable("HOME");
    if (!state.isEmpty()) return state + "/searchlight";
    return home.isEmpty() ? QString() : home + "/.local/state/searchlight";
}

QString Recovery::ownFile() const { return QString("%1/recovery-%2.json").arg(folder_).arg(getpid()); }

void Recovery::write() {
    if (!dirty_ || folder_.isEmpty()) return;
    dirty_ = false;
    try {
        makeFolder(folder_.toStdString());
        writeFile(ownFile().toStdString(), workspaceJson(workspace_.state()));
    } catch (const Error&) {
        // A full disk must not stop the work; the next change tries again.
        dirty_ = true;
    }
}

std::optional<State> Recovery::take() {
    if (folder_.isEmpty()) return std::nullopt;
    std::optional<State> newest;
    const QFileInfoList left =
        QDir(folder_).entryInfoList({"recovery-*.json"}, QDir::Files, QDir::Time);  // newest first
    for (const QFileInfo& file : left) {
        if (runs(file.completeBaseName().section('-', 1).toLongLong())) continue;
        const std::string path = file.absoluteFilePath().toStdString();
        try {
            if (!newest) newest = parseWorkspace(readFile(path), path);
        } catch (const Error&) {
            // Cut off by the crash itself.
        }
        QFile::remove(file.absoluteFilePath());
    }
    return newest;
}

}  // namespace searchlight::gui
