// What every dock works with.
#pragma once

#include <QObject>
#include <QString>

#include "gui/state/workspace.h"
#include "gui/tasks/tasks.h"

namespace searchlight::gui {

class Theme;

/// What the program says to the user: shown for a while above the status bar.
class Notices : public QObject {
    Q_OBJECT

public:
    enum class Level { info, warning, error };
    using QObject::QObject;

    void post(Level level, const QString& text) { emit posted(level, text); }
    void post(const Error& error) { emit posted(Level::error, QString::fromUtf8(error.what())); }

Q_SIGNALS:
    void posted(searchlight::gui::Notices::Level level, const QString& text);
};

/// Moments that `--trace` reports, in ms since the program started.
class Trace : public QObject {
    Q_OBJECT

public:
    using QObject::QObject;

    /// Something became visible: "picture", "curves", "reference".
    void shown(const QString& what) { emit happened(what); }

Q_SIGNALS:
    void happened(const QString& what);
};

/// Outlives all docks.
struct Desk {
    Workspace& workspace;
    Tasks& tasks;
    Theme& theme;
    Notices& notices;
    Trace& trace;
};

}  // namespace searchlight::gui
