// What is wrong with the models of a workspace, whoever found out.
#pragma once

#include <QObject>
#include <map>
#include <optional>
#include <string>

#include "base/error.h"
#include "gui/state/workspace.h"

namespace searchlight::gui {

class ModelStatus : public QObject {
    Q_OBJECT

public:
    /// The one of that workspace: made when first asked for, and its child.
    static ModelStatus& of(Workspace& workspace);

    /// By id. `problem` empty: it works.
    void set(const std::string& id, std::optional<Error> problem);
    /// Null: none is known.
    const Error* problem(const std::string& id) const;

Q_SIGNALS:
    void changed();

private:
    explicit ModelStatus(QObject* parent) : QObject(parent) {}

    std::map<std::string, Error> problems_;
};

}  // namespace searchlight::gui
