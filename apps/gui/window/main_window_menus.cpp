// Menus, the tool bar, and the boxes of the Help menu.
#include <QAction>
#include <QApplication>
#include <QDockWidget>
#include <QFileDialog>
#include <QIcon>
#include <QMenuBar>
#include <QMessageBox>
#include <QToolBar>
#include <QToolButton>

#include "geometry/object.h"
#include "gui/state/open_path.h"
#include "gui/view/object_view.h"
#include "gui/window/docks.h"
#include "gui/window/main_window.h"
#include "gui/window/theme.h"

namespace searchlight::gui {

void MainWindow::makeFileMenu() {
    QMenu* file = menuBar()->addMenu(tr("&File"));
    const auto add = [&](QMenu* menu, const char* icon, const QString& text, const QKeySequence& keys, auto&& call) {
        QAction* action = menu->addAction(text, keys, this, call);
        if (*icon) {
            action->setIcon(desk_.theme.icon(icon));
            action->setIconVisibleInMenu(false);
            icons_.emplace_back(action, icon);
        }
        return action;
    };
    QAction* open = add(file, "open", tr("&Open..."), QKeySequence::Open,
                        [this] { openPaths(QFileDialog::getOpenFileNames(this, tr("Open"), {}, openFilter())); });
    QMenu* objects = file->addMenu(tr("Built-in &object"));
    for (const std::string& id : builtInObjects())
        objects->addAction(QString::fromStdString(id).replace('_', ' '), this, [this, id] {
            desk_.workspace.edit(tr("Object"), {}, [&](State& state) { state.scene.object = id; });
        });
    QAction* save = add(file, "save", tr("&Save workspace"), QKeySequence::Save, [this] { this->save(); });
    add(file, "", tr("Save workspace &as..."), QKeySequence::SaveAs, [this] { saveTo({}); });
    file->addSeparator();
    QAction* picture = add(file, "picture", tr("Save &picture..."), QKeySequence("Ctrl+P"), [this] { savePicture(); });
    QAction* command =
        add(file, "terminal", tr("&Copy as command line"), QKeySequence("Ctrl+Shift+C"), [this] { copyCommand(); });
    file->addSeparator();
    add(file, "", tr("&Quit"), QKeySequence::Quit, [this] { close(); });

    QMenu* edit = menuBar()->addMenu(tr("&Edit"));
    QAction* undo = desk_.workspace.undoStack().createUndoAction(this, tr("Undo"));
    undo->setShortcut(QKeySequence::Undo);
    QAction* redo = desk_.workspace.undoStack().createRedoAction(this, tr("Redo"));
    redo->setShortcuts({QKeySequence(QKeySequence::Redo), QKeySequence("Ctrl+Y")});
    edit->addActions({undo, redo});
    for (const auto& [action, icon] : {std::pair{undo, "undo"}, std::pair{redo, "redo"}}) {
        action->setIcon(desk_.theme.icon(icon));
        action->setIconVisibleInMenu(false);
        icons_.emplace_back(action, icon);
    }
    for (QAction* each : {open, save, undo, redo, picture, command}) tools_.push_back(each);
}

void MainWindow::makeViewMenu() {
    QMenu* view = menuBar()->addMenu(tr("&View"));
    for (std::size_t i = 0; i < docks_.size(); ++i) view->addAction(makeDockAction(docks()[i], docks_[i]));
    view->addSeparator();
    QAction* frame = view->addAction(tr("&Frame the object"), QKeySequence("F"), view_, &ObjectView::frame);
    frame->setShortcutContext(Qt::WidgetShortcut);
    view_->addAction(frame);
    view->addAction(tr("&Reset layout"), this, &MainWindow::placeDocks);
    QMenu* themes = view->addMenu(tr("&Theme"));
    for (const char* name : {"Dark", "Light", "System"})
        themes->addAction(tr(name), this, [this, name] { setTheme(QString(name).toLower()); });
    QMenu* help = menuBar()->addMenu(tr("&Help"));
    help->addAction(tr("&Welcome"), this, &MainWindow::showWelcome);
    help->addAction(tr("&Keys"), QKeySequence("F1"), this, &MainWindow::showKeys);
    help->addAction(tr("&About"), this, &MainWindow::about);
}

// Checked while a person sees the dock: one behind another tab is brought to the front, not closed.
QAction* MainWindow::makeDockAction(const DockEntry& entry, QDockWidget* dock) {
    auto* action = new QAction(desk_.theme.icon(entry.icon), tr(entry.title), this);
    action->setObjectName(QString("show.") + entry.id);
    action->setCheckable(true);
    action->setShortcut(QKeySequence(QString::fromLatin1(entry.shortcut)));
    action->setToolTip(QString("%1 (%2)").arg(tr(entry.doc), entry.shortcut));
    action->setIconVisibleInMenu(false);
    icons_.emplace_back(action, entry.icon);
    connect(dock, &QDockWidget::visibilityChanged, action, &QAction::setChecked);
    connect(action, &QAction::triggered, this, [this, dock, id = QString(entry.id)](bool on) {
        if (on)
            showDock(id);
        else
            dock->close();
    });
    dock_actions_.push_back(action);
    return action;
}

void MainWindow::makeToolBar() {
    QToolBar* bar = addToolBar(tr("Tools"));
    bar->setObjectName("tools");
    bar->setMovable(false);
    bar->setIconSize({18, 18});
    for (std::size_t i = 0; i < tools_.size(); ++i) {
        if (i == 2 || i == 4) bar->addSeparator();
        bar->addAction(tools_[i]);
    }
    auto* space = new QWidget(bar);
    space->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
    bar->addWidget(space);
    for (QAction* action : dock_actions_) bar->addAction(action);
    bar->addSeparator();
    QAction* theme = bar->addAction(desk_.theme.icon("theme"), tr("Light or dark"), this,
                                    [this] { setTheme(desk_.theme.isDark() ? "light" : "dark"); });
    icons_.emplace_back(theme, "theme");
    for (QToolButton* button : bar->findChildren<QToolButton*>()) {
        button->setFocusPolicy(Qt::TabFocus);
        if (button->defaultAction()) button->setAccessibleName(button->defaultAction()->text().remove('&'));
    }
}

void MainWindow::showKeys() {
    auto* box = new QMessageBox(QMessageBox::NoIcon, tr("Keys"), {}, QMessageBox::Close, this);
    box->setAttribute(Qt::WA_DeleteOnClose);
    QString rows;
    const auto row = [&](const QString& keys, const QString& what) {
        rows += QString("<tr><td style=\"padding-right: 24px\"><b>%1</b></td><td>%2</td></tr>").arg(keys, what);
    };
    row(tr("Drag, arrows"), tr("turn the object"));
    row(tr("Right drag, Ctrl + arrows"), tr("turn the light"));
    row(tr("Middle drag, Shift + arrows"), tr("move the object"));
    row(tr("Wheel, + and -"), tr("zoom"));
    row(tr("F"), tr("frame the object"));
    row(tr("Alt + left and right"), tr("move the wipe"));
    for (const QAction* each : dock_actions_) row(each->shortcut().toString(), tr("show or hide %1").arg(each->text()));
    row("Ctrl+Z, Ctrl+Shift+Z", tr("undo, redo: everything but the layout"));
    row("Ctrl+Shift+C", tr("copy as command line"));
    row("Ctrl+P", tr("save picture"));
    box->setText("<table>" + rows + "</table>");
    box->open();
}

void MainWindow::about() {
    auto* box = new QMessageBox(QMessageBox::NoIcon, tr("About Searchlight"), {}, QMessageBox::Close, this);
    box->setAttribute(Qt::WA_DeleteOnClose);
    box->setIconPixmap(QIcon(":/searchlight.svg").pixmap(64, 64));
    box->setText(tr("<b>Searchlight %1</b><br>A laboratory for BSSRDFs.<br>Apache-2.0; Qt under the LGPL. Nothing is "
                    "sent anywhere.")
                     .arg(QApplication::applicationVersion()));
    box->open();
}

}  // namespace searchlight::gui
