#include "gui/window/main_window.h"

#include <QAction>
#include <QApplication>
#include <QClipboard>
#include <QCloseEvent>
#include <QDockWidget>
#include <QDragEnterEvent>
#include <QFileDialog>
#include <QFileInfo>
#include <QMessageBox>
#include <QMimeData>
#include <QScreen>
#include <QSettings>
#include <QStatusBar>
#include <QVBoxLayout>
#include <algorithm>
#include <map>

#include "gui/models/models_dock.h"
#include "gui/state/command_line.h"
#include "gui/state/open_path.h"
#include "gui/view/object_view.h"
#include "gui/view/save_picture.h"
#include "gui/window/dock_title.h"
#include "gui/window/docks.h"
#include "gui/window/notice_bar.h"
#include "gui/window/task_bar.h"
#include "gui/window/theme.h"
#include "gui/window/view_bar.h"
#include "gui/window/welcome.h"

namespace searchlight::gui {

namespace {

// Counts up when docks change so much that an old layout would hide them.
constexpr int layout_version = 2;

// Below it the object and code do not stand side by side.
constexpr int room_for_code = 1400;

// With the frame that a desktop puts around it. The screen of "offscreen" is nobody's.
QSize sizeForScreen() {
    const QSize wanted(1440, 900), frame(4, 32);
    const QScreen* screen = QGuiApplication::primaryScreen();
    if (!screen || QGuiApplication::platformName() == "offscreen") return wanted;
    return wanted.boundedTo(screen->availableSize() - frame);
}

}  // namespace

MainWindow::MainWindow(Desk& desk, QString settings_file, QSize size, QWidget* parent)
    : QMainWindow(parent), desk_(desk), settings_file_(std::move(settings_file)) {
    setObjectName("main");
    setWindowIcon(QIcon(":/searchlight.svg"));
    // Qt 6.4 crashes within groups of docks that are dragged together, and while it animates docks that change.
    setDockOptions(AllowNestedDocks | AllowTabbedDocks);
    setTabPosition(Qt::AllDockWidgetAreas, QTabWidget::North);
    setCorner(Qt::BottomLeftCorner, Qt::LeftDockWidgetArea);
    setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
    setAcceptDrops(true);
    resize(size.isEmpty() ? sizeForScreen() : size);

    auto* middle = new QWidget(this);
    auto* column = new QVBoxLayout(middle);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(0);
    view_ = new ObjectView(desk_, middle);
    auto* bar = new ViewBar(desk_, middle);
    column->addWidget(bar);
    column->addWidget(view_, 1);
    setCentralWidget(middle);
    new NoticeBar(desk_, view_);
    makeDocks();
    makeFileMenu();
    makeViewMenu();
    makeToolBar();
    statusBar()->addPermanentWidget(new TaskBar(desk_, this));
    statusBar()->setSizeGripEnabled(false);
    placeDocks();
    restoreLayout();
    connect(&desk_.workspace, &Workspace::fileChanged, this, &MainWindow::refreshTitle);
    connect(&desk_.tasks, &Tasks::taskFailed, this,
            [this](const QString&, const Error& error) { desk_.notices.post(error); });
    connect(&desk_.theme, &Theme::changed, this, [this] {
        for (const auto& [action, name] : icons_) action->setIcon(desk_.theme.icon(name));
    });
    refreshTitle();
}

MainWindow::~MainWindow() = default;

void MainWindow::makeDocks() {
    for (const DockEntry& entry : docks()) {
        auto* dock = new QDockWidget(tr(entry.title), this);
        dock->setObjectName(QString("dock.") + entry.id);
        dock->setAccessibleName(tr(entry.title));
        dock->setAccessibleDescription(tr(entry.doc));
        dock->setTitleBarWidget(new DockTitle(desk_.theme, dock));
        QWidget* body = entry.make(desk_);
        body->setAccessibleName(tr(entry.title));
        // What stands in tabs that are not shown must not make the window wide.
        const bool below = entry.area == Qt::BottomDockWidgetArea;
        body->setMinimumSize(below ? 420 : 260, below ? 150 : 200);
        dock->setWidget(body);
        docks_.push_back(dock);
    }
}

void MainWindow::placeDocks() {
    std::map<Qt::DockWidgetArea, QDockWidget*> first;
    for (std::size_t i = 0; i < docks_.size(); ++i) {
        const DockEntry& entry = docks()[i];
        const bool narrow = entry.area == Qt::RightDockWidgetArea && width() < room_for_code;
        const Qt::DockWidgetArea area = narrow ? Qt::BottomDockWidgetArea : entry.area;
        removeDockWidget(docks_[i]);
        docks_[i]->setFloating(false);
        addDockWidget(area, docks_[i]);
        if (QDockWidget*& leader = first[area]; leader)
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
            heights << std::clamp(height() * 36 / 100, 270, 400);
        } else {
            sides << dock;
            // Room for code on the right, where there is some.
            widths << (area == Qt::RightDockWidgetArea && width() > 1600 ? 460 : 340);
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

bool MainWindow::showDock(const QString& id) {
    QDockWidget* found = dock(id);
    if (!found) return false;
    found->show();
    found->raise();
    found->widget()->setFocus();
    return true;
}

void MainWindow::showWelcome() {
    if (!welcome_) {
        welcome_ = new Welcome(desk_, view_);
        connect(welcome_, &Welcome::closed, this, [this] { closeWelcome(); });
        connect(welcome_, &Welcome::chosen, this, [this](const QString& way) {
            closeWelcome();
            begin(way);
        });
    }
    welcome_->show();
    welcome_->raise();
}

void MainWindow::closeWelcome() {
    if (welcome_) welcome_->deleteLater();
    welcome_ = nullptr;
    if (settings_file_.isEmpty()) return;
    QSettings settings(settings_file_, QSettings::IniFormat);
    settings.setValue("welcomed", true);
}

void MainWindow::begin(const QString& way) {
    if (way != "compare") {
        // A shipped model can be read; what can be written at once is a template.
        if (way == "editor") {
            try {
                addNewModel(desk_.workspace, "radial");
            } catch (const Error& error) {
                desk_.notices.post(error);
            }
        }
        showDock(way);
        // Code below the object needs more room than a plot.
        if (way == "editor" && dockWidgetArea(dock(way)) == Qt::BottomDockWidgetArea)
            resizeDocks({dock(way)}, {height() / 2}, Qt::Vertical);
        // Beside it, lines of code want to be seen whole.
        if (way == "editor" && dockWidgetArea(dock(way)) == Qt::RightDockWidgetArea)
            resizeDocks({dock(way)}, {std::max(dock(way)->width(), std::min(width() * 2 / 5, 600))}, Qt::Horizontal);
        return;
    }
    desk_.workspace.edit(tr("Compare with the reference"), {}, [](State& state) {
        state.options["view"]["compare"] = std::string("wipe");
        state.options["view"]["against"] = std::string("reference");
    });
    showDock("plot");
}

void MainWindow::savePicture() {
    const ViewPicture& shown = view_->pictures().shown();
    if (!shown.linear_a) return desk_.notices.post(Notices::Level::info, tr("There is no picture yet."));
    const QString path =
        QFileDialog::getSaveFileName(this, tr("Save picture"), "picture.png", tr("Pictures (*.png *.exr *.hdr *.pfm)"));
    if (path.isEmpty()) return;
    writePicture(desk_, shown, path, this);
}

void MainWindow::copyCommand() {
    const ViewPicture& shown = view_->pictures().shown();
    const QSize size = view_->size() * view_->devicePixelRatioF();
    QApplication::clipboard()->setText(QString::fromStdString(commandLine(
        desk_.workspace.state(),
        {.path = "picture.png", .width = size.width(), .height = size.height(), .exposure = shown.exposure})));
    desk_.notices.post(Notices::Level::info,
                       tr("The command that makes the picture of %1 is in the clipboard.").arg(shown.label_a));
}

void MainWindow::setTheme(const QString& name) {
    desk_.theme.apply(name == "light"    ? Theme::Mode::light
                      : name == "system" ? Theme::Mode::system
                                         : Theme::Mode::dark);
    if (settings_file_.isEmpty()) return;
    QSettings settings(settings_file_, QSettings::IniFormat);
    settings.setValue("theme", name);
}

QString MainWindow::rememberedTheme(const QString& settings_file) {
    if (settings_file.isEmpty()) return "dark";
    return QSettings(settings_file, QSettings::IniFormat).value("theme", "dark").toString();
}

void MainWindow::refreshTitle() {
    const QString path = desk_.workspace.path();
    setWindowTitle(QString("%1[*] - Searchlight").arg(path.isEmpty() ? tr("Untitled") : QFileInfo(path).fileName()));
    setWindowModified(desk_.workspace.isModified());
}

void MainWindow::openPaths(const QStringList& paths) {
    // Who brings something knows what to do with it.
    if (welcome_ && !paths.isEmpty()) welcome_->hide();
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
    if (settings_file_.isEmpty()) return showWelcome();
    const QSettings settings(settings_file_, QSettings::IniFormat);
    if (!settings.value("welcomed").toBool()) showWelcome();
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
