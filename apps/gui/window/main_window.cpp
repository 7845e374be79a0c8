#include "gui/window/main_window.h"

#include <QAction>
#include <QCloseEvent>
#include <QDockWidget>
#include <QDragEnterEvent>
#include <QFileDialog>
#include <QFileInfo>
#include <QMenuBar>
#include <QMessageBox>
#include <QMimeData>
#include <QSettings>
#include <QStatusBar>
#include <QToolBar>

#include "gui/state/open_path.h"
#include "gui/view/object_view.h"
#include "gui/window/docks.h"
#include "gui/window/notice_bar.h"
#include "gui/window/task_bar.h"
#include "gui/window/theme.h"

namespace searchlight::gui {

namespace {

// Counts up when docks change so much that an old layout would hide them.
constexpr int layout_version = 1;

}  // namespace

MainWindow::MainWindow(Desk& desk, QString settings_file, QWidget* parent)
    : QMainWindow(parent), desk_(desk), settings_file_(std::move(settings_file)) {
    setObjectName("main");
    setWindowIcon(QIcon(":/searchlight.svg"));
    setDockOptions(AnimatedDocks | AllowNestedDocks | AllowTabbedDocks | GroupedDragging);
    setTabPosition(Qt::AllDockWidgetAreas, QTabWidget::North);
    setCorner(Qt::BottomLeftCorner, Qt::LeftDockWidgetArea);
    setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
    setAcceptDrops(true);
    resize(1440, 900);

    view_ = new ObjectView(desk_, this);
    setCentralWidget(view_);
    notices_ = new NoticeBar(desk_, view_);
    makeDocks();
    makeMenus();
    makeToolBar();
    makeStatusBar();
    placeDocks();
    restoreLayout();
    connect(&desk_.workspace, &Workspace::fileChanged, this, &MainWindow::refreshTitle);
    connect(&desk_.tasks, &Tasks::taskFailed, this,
            [this](const QString&, const Error& error) { desk_.notices.post(error); });
    refreshTitle();
}

MainWindow::~MainWindow() = default;

void MainWindow::makeDocks() {
    for (const DockEntry& entry : docks()) {
        auto* dock = new QDockWidget(tr(entry.title), this);
        dock->setObjectName(QString("dock.") + entry.id);
        dock->setAccessibleName(tr(entry.title));
        dock->setAccessibleDescription(tr(entry.doc));
        QWidget* body = entry.make(desk_);
        body->setAccessibleName(tr(entry.title));
        dock->setWidget(body);
        dock->toggleViewAction()->setShortcut(QKeySequence(QString::fromLatin1(entry.shortcut)));
        dock->toggleViewAction()->setToolTip(tr(entry.doc));
        docks_.push_back(dock);
    }
}

void MainWindow::placeDocks() {
    std::map<Qt::DockWidgetArea, QDockWidget*> first;
    for (std::size_t i = 0; i < docks_.size(); ++i) {
        const DockEntry& entry = docks()[i];
        removeDockWidget(docks_[i]);
        docks_[i]->setFloating(false);
        addDockWidget(entry.area, docks_[i]);
        if (QDockWidget*& leader = first[entry.area]; leader)
            tabifyDockWidget(leader, docks_[i]);
        else
            leader = docks_[i];
        docks_[i]->setVisible(entry.shown);
    }
    QList<QDockWidget*> sides, bottoms;
    QList<int> widths, heights;
    for (const auto& [area, dock] : first) {
        dock->raise();
        if (area == Qt::BottomDockWidgetArea) {
            bottoms << dock;
            heights << 300;
        } else {
            sides << dock;
            widths << 340;
        }
    }
    resizeDocks(sides, widths, Qt::Horizontal);
    resizeDocks(bottoms, heights, Qt::Vertical);
}

QDockWidget* MainWindow::dock(const QString& id) const {
    for (QDockWidget* each : docks_)
        if (each->objectName() == "dock." + id) return each;
    return nullptr;
}

void MainWindow::makeMenus() {
    QMenu* file = menuBar()->addMenu(tr("&File"));
    file->addAction(tr("&Open..."), QKeySequence::Open, this, [this] {
        const QStringList paths = QFileDialog::getOpenFileNames(this, tr("Open"), {}, openFilter());
        openPaths(paths);
    });
    file->addAction(tr("&Save workspace"), QKeySequence::Save, this, &MainWindow::save);
    file->addAction(tr("Save workspace &as..."), QKeySequence::SaveAs, this, [this] { saveTo({}); });
    file->addSeparator();
    file->addAction(tr("&Quit"), QKeySequence::Quit, this, &QWidget::close);

    QMenu* edit = menuBar()->addMenu(tr("&Edit"));
    QAction* undo = desk_.workspace.undoStack().createUndoAction(this, tr("Undo"));
    undo->setShortcut(QKeySequence::Undo);
    QAction* redo = desk_.workspace.undoStack().createRedoAction(this, tr("Redo"));
    redo->setShortcuts({QKeySequence(QKeySequence::Redo), QKeySequence("Ctrl+Y")});
    edit->addActions({undo, redo});

    QMenu* view = menuBar()->addMenu(tr("&View"));
    for (QDockWidget* each : docks_) view->addAction(each->toggleViewAction());
    view->addSeparator();
    view->addAction(tr("&Reset layout"), this, &MainWindow::placeDocks);
}

void MainWindow::makeToolBar() {}

void MainWindow::makeStatusBar() { statusBar()->addPermanentWidget(new TaskBar(desk_, this)); }

void MainWindow::refreshTitle() {
    const QString path = desk_.workspace.path();
    setWindowTitle(QString("%1[*] - Searchlight").arg(path.isEmpty() ? tr("Untitled") : QFileInfo(path).fileName()));
    setWindowModified(desk_.workspace.isModified());
}

void MainWindow::openPaths(const QStringList& paths) {
    for (const QString& path : paths) {
        try {
            openPath(desk_.workspace, path);
        } catch (const Error& error) {
            desk_.notices.post(error);
        }
    }
}

bool MainWindow::saveTo(const QString& given) {
    QString path = given;
    if (path.isEmpty()) path = QFileDialog::getSaveFileName(this, tr("Save workspace"), {}, tr("Workspace (*.json)"));
    if (path.isEmpty()) return false;
    try {
        desk_.workspace.save(path);
        return true;
    } catch (const Error& error) {
        desk_.notices.post(error);
        return false;
    }
}

bool MainWindow::save() { return saveTo(desk_.workspace.path()); }

bool MainWindow::mayDiscard() {
    if (!desk_.workspace.isModified() || desk_.workspace.path().isEmpty()) return true;
    const auto answer = QMessageBox::question(this, tr("Searchlight"), tr("Save the changes to the workspace?"),
                                              QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel);
    if (answer == QMessageBox::Save) return save();
    return answer == QMessageBox::Discard;
}

void MainWindow::restoreLayout() {
    if (settings_file_.isEmpty()) return;
    const QSettings settings(settings_file_, QSettings::IniFormat);
    restoreGeometry(settings.value("geometry").toByteArray());
    restoreState(settings.value("layout").toByteArray(), layout_version);
}

void MainWindow::closeEvent(QCloseEvent* event) {
    if (!mayDiscard()) return event->ignore();
    if (!settings_file_.isEmpty()) {
        QSettings settings(settings_file_, QSettings::IniFormat);
        settings.setValue("geometry", saveGeometry());
        settings.setValue("layout", saveState(layout_version));
    }
    event->accept();
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
    if (event->mimeData()->hasUrls()) event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
    QStringList paths;
    for (const QUrl& url : event->mimeData()->urls())
        if (url.isLocalFile()) paths << url.toLocalFile();
    openPaths(paths);
    event->acceptProposedAction();
}

}  // namespace searchlight::gui
