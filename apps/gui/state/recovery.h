// What was not saved survives a crash: the workspace, written every few seconds while it differs from its file.
#pragma once

#include <QObject>
#include <QTimer>
#include <optional>

#include "gui/state/workspace.h"

namespace searchlight::gui {

class Recovery : public QObject {
    Q_OBJECT

public:
    /// `folder`: where it is kept, made when needed.
    Recovery(Workspace& workspace, QString folder, QObject* parent = nullptr);
    /// A program that ends as it should leaves nothing.
    ~Recovery() override;

    /// The newest workspace that a program left which is no more, taken away from there; none: nothing was left, or it
    /// cannot be read.
    std::optional<State> take();

    /// Writes now if there is something to write.
    void write();

    /// $XDG_STATE_HOME/searchlight, or ~/.local/state/searchlight; empty when neither variable is set.
    static QString userFolder();

private:
    QString ownFile() const;

    Workspace& workspace_;
    QString folder_;
    QTimer timer_;
    bool dirty_ = false;
};

}  // namespace searchlight::gui
