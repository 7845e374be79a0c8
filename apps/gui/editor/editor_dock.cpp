#include "gui/editor/editor_dock.h"

#include <QFileInfo>
#include <QFileSystemWatcher>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QTimer>
#include <QToolButton>
#include <QVBoxLayout>
#include <map>

#include "base/files.h"
#include "gui/editor/bssrdf_highlighter.h"
#include "gui/editor/code_edit.h"
#include "gui/models/model_files.h"
#include "gui/models/model_status.h"
#include "gui/models/models_dock.h"
#include "gui/window/theme.h"
#include "job/live/try_model.h"

namespace searchlight::gui {

namespace {

constexpr int kPause = 350;  // ms without a key before the text is tried

class EditorDock : public QWidget {
public:
    explicit EditorDock(Desk& desk) : desk_(desk) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(0);
        layout->addLayout(makeBar());
        edit_ = new CodeEdit(desk.theme, this);
        edit_->setObjectName(QStringLiteral("editor.text"));
        edit_->setFrameShape(QFrame::NoFrame);
        new BssrdfHighlighter(desk.theme, edit_->document());
        layout->addWidget(edit_, 1);
        message_ = new QPushButton(this);
        message_->setObjectName(QStringLiteral("editor.message"));
        message_->setFlat(true);
        message_->setToolTip(tr("Go to the line"));
        message_->setStyleSheet(QStringLiteral("text-align: left; padding: 4px 8px;"));
        connect(message_, &QPushButton::clicked, this, [this] {
            if (edit_->problem()) edit_->goTo(edit_->problem()->line, edit_->problem()->column);
        });
        layout->addWidget(message_);
        pause_.setSingleShot(true);
        pause_.setInterval(kPause);
        connect(&pause_, &QTimer::timeout, this, [this] { tryText(); });
        connect(edit_, &QPlainTextEdit::textChanged, this, [this] { typed(); });
        connect(&desk_.workspace, &Workspace::changed, this, [this](Change change) {
            if (change.any({Part::models, Part::active})) load();
        });
        connect(&watcher_, &QFileSystemWatcher::fileChanged, this, [this] { fileChanged(); });
        connect(&desk_.workspace, &Workspace::modelFileChanged, this, [this](const QString& id) {
            if (id.toStdString() == id_ && !writing_) fileChanged();
        });
        connect(edit_, &CodeEdit::saveWished, this, [this] { write(); });
        load();
    }

private:
    QLayout* makeBar() {
        auto* bar = new QHBoxLayout;
        bar->setContentsMargins(Space::s, Space::xs, Space::s, Space::xs);
        bar->setSpacing(Space::s);
        name_ = new QLabel(this);
        name_->setObjectName(QStringLiteral("editor.name"));
        name_->setTextFormat(Qt::PlainText);
        bar->addWidget(name_, 1);
        copy_ = new QPushButton(tr("Edit a copy"), this);
        copy_->setObjectName(QStringLiteral("editor.copy"));
        copy_->setToolTip(tr("This model is part of the program: a copy becomes a file of yours"));
        connect(copy_, &QPushButton::clicked, this, [this] { editCopy(); });
        bar->addWidget(copy_);
        live_ = new QToolButton(this);
        live_->setObjectName(QStringLiteral("editor.live"));
        live_->setText(tr("Live"));
        live_->setAccessibleName(tr("Live: write the file when typing pauses"));
        live_->setCheckable(true);
        live_->setToolTip(tr("When typing pauses and the text works, it is written, and all pictures follow"));
        bar->addWidget(live_);
        save_ = new QToolButton(this);
        save_->setObjectName(QStringLiteral("editor.save"));
        save_->setAccessibleName(tr("Save the model"));
        save_->setToolTip(tr("Save (Ctrl+S)"));
        const auto paint = [this] { save_->setIcon(desk_.theme.icon(QStringLiteral("save"))); };
        paint();
        connect(&desk_.theme, &Theme::changed, save_, paint);
        connect(save_, &QToolButton::clicked, this, [this] { write(); });
        bar->addWidget(save_);
        return bar;
    }

    // The active model's text: what was typed and not saved, or what the file holds.
    void load() {
        const std::string id = desk_.workspace.state().activeModel().model.id;
        if (id == id_) return;
        keepUnsaved();
        id_ = id;
        pause_.stop();
        if (!watcher_.files().isEmpty()) watcher_.removePaths(watcher_.files());
        ModelText text;
        try {
            text = modelText(id);
        } catch (const Error& error) {
            text.path = QString::fromStdString(id);
            show(text, {});
            return setProblem(error);
        }
        path_ = text.path;
        if (!path_.isEmpty() && QFileInfo::exists(path_)) watcher_.addPath(path_);
        const auto kept = unsaved_.find(id);
        show(text, kept == unsaved_.end() ? text.text : kept->second);
        modified_ = kept != unsaved_.end();
        setProblem({});
        showName();
        if (text.why_not.isEmpty()) pause_.start();
    }

    void keepUnsaved() {
        if (id_.empty()) return;
        if (modified_)
            unsaved_[id_] = edit_->toPlainText();
        else
            unsaved_.erase(id_);
    }

    void show(const ModelText& text, const QString& shown) {
        loading_ = true;
        edit_->setPlainText(text.why_not.isEmpty() ? shown : text.why_not);
        edit_->setReadOnly(!text.writable);
        edit_->document()->clearUndoRedoStacks();
        loading_ = false;
        writable_ = text.writable;
        modified_ = false;
        copy_->setVisible(text.path.isEmpty() && text.why_not.isEmpty());
        for (QToolButton* each : {live_, save_}) each->setVisible(text.writable);
        showName();
    }

    void showName() {
        QString name = path_.isEmpty() ? tr("%1  (read only)").arg(QString::fromStdString(id_))
                                       : path_.section(QLatin1Char('/'), -1);
        if (modified_) name += QStringLiteral(" •");
        name_->setText(name);
        name_->setToolTip(path_);
    }

    void typed() {
        if (loading_) return;
        modified_ = true;
        showName();
        pause_.start();
    }

    // On a thread of its own: a shader that the driver takes seconds for does not stop the window.
    void tryText() {
        const QString text = edit_->toPlainText();
        const std::string path = path_.isEmpty() ? id_ + ".bssrdf" : path_.toStdString();
        const std::string id = id_;
        desk_.tasks.start({.lane = "editor", .key = "try", .title = tr("Compiling the model"), .receiver = this},
                          [this, text, path, id](TaskContext& context) {
                              auto problem = std::make_shared<std::optional<Error>>(
                                  tryModel(text.toStdString(), path, context.engine()));
                              context.publish([this, problem, id, text] { tried(id, text, *problem); });
                          });
    }

    void tried(const std::string& id, const QString& text, const std::optional<Error>& problem) {
        if (id != id_) return;
        setProblem(problem);
        if (!problem && modified_ && live_->isChecked() && text == edit_->toPlainText()) write();
        // What is on disk is what the pictures show: a text that was not written does not speak for it.
        if (!modified_) ModelStatus::of(desk_.workspace).set(id, problem);
    }

    void setProblem(const std::optional<Error>& problem) {
        edit_->setProblem(problem);
        message_->setVisible(true);
        QPalette palette = message_->palette();
        palette.setColor(QPalette::ButtonText, problem ? desk_.theme.colors().error : desk_.theme.colors().muted);
        message_->setPalette(palette);
        if (!problem) {
            message_->setText(tr("No errors"));
            return;
        }
        QString text = QString::fromStdString(problem->message).section(QLatin1Char('\n'), 0, 0);
        if (problem->line > 0) text = tr("Line %1: %2").arg(problem->line).arg(text);
        message_->setText(text);
        message_->setToolTip(QString::fromUtf8(problem->what()));
    }

    void write() {
        if (!writable_) return;
        try {
            writing_ = true;
            writeFile(path_.toStdString(), edit_->toPlainText().toStdString());
            modified_ = false;
            unsaved_.erase(id_);
            showName();
            if (!watcher_.files().contains(path_)) watcher_.addPath(path_);
            ModelStatus::of(desk_.workspace).set(id_, {});
            desk_.workspace.noteModelFile(QString::fromStdString(id_));
        } catch (const Error& error) {
            desk_.notices.post(error);
        }
        writing_ = false;
    }

    // By another program, which may have put a new file in the old one's place.
    void fileChanged() {
        if (path_.isEmpty() || !QFileInfo::exists(path_)) return;
        if (!watcher_.files().contains(path_)) watcher_.addPath(path_);
        try {
            const ModelText text = modelText(id_);
            if (text.text == edit_->toPlainText()) return;
            if (modified_)
                return desk_.notices.post(Notices::Level::warning,
                                          tr("%1 has changed on disk; what you typed is kept until you save.")
                                              .arg(path_.section(QLatin1Char('/'), -1)));
            show(text, text.text);
            pause_.start();
            if (!writing_) {
                writing_ = true;
                desk_.workspace.noteModelFile(QString::fromStdString(id_));
                writing_ = false;
            }
        } catch (const Error& error) {
            desk_.notices.post(error);
        }
    }

    // The slot goes on with the copy, so that colour and parameters stay.
    void editCopy() {
        try {
            const QString id = QString::fromStdString(id_), path = freeModelPath(QStringLiteral("my_") + id);
            writeFile(path.toStdString(), edit_->toPlainText().toStdString());
            desk_.workspace.edit(tr("Edit a copy"), {}, [&](State& state) {
                state.models[static_cast<std::size_t>(state.active)].model.id = path.toStdString();
            });
            edit_->setFocus();
        } catch (const Error& error) {
            desk_.notices.post(error);
        }
    }

    Desk& desk_;
    CodeEdit* edit_ = nullptr;
    QLabel* name_ = nullptr;
    QPushButton *copy_ = nullptr, *message_ = nullptr;
    QToolButton *live_ = nullptr, *save_ = nullptr;
    QTimer pause_;
    QFileSystemWatcher watcher_;
    std::string id_;
    QString path_;
    std::map<std::string, QString> unsaved_;
    bool loading_ = false, modified_ = false, writable_ = false, writing_ = false;
};

}  // namespace

QWidget* makeEditorDock(Desk& desk) { return new EditorDock(desk); }

}  // namespace searchlight::gui
