// The window: the object view in the middle, docks around it, menus, and the status bar.
#pragma once

#include <QMainWindow>
#include <QStringList>
#include <utility>
#include <vector>

#include "gui/window/desk.h"

class QAction;

namespace searchlight::gui {

struct DockEntry;
class ObjectView;
class Welcome;

class MainWindow : public QMainWindow {
    Q_OBJECT

public:
    /// `settings_file`: where layout and theme are remembered; empty: nowhere. An empty `size` is one that fits the
    /// screen; the layout of the first start is made for it.
    explicit MainWindow(Desk& desk, QString settings_file = {}, QSize size = {}, QWidget* parent = nullptr);
    ~MainWindow() override;

    /// "dark", "light" or "system", as last chosen; dark at first.
    static QString rememberedTheme(const QString& settings_file);

    /// Workspaces, scenes, shapes, pictures of light, models: what a path is, its ending says. Faults are notices.
    void openPaths(const QStringList& paths);

    /// The dock of that id (docks.cpp); null: none.
    QDockWidget* dock(const QString& id) const;

    /// Brings it to the front, with the focus. False: there is none of that id.
    bool showDock(const QString& id);

    ObjectView& view() { return *view_; }

protected:
    void closeEvent(QCloseEvent* event) override;
    void dragEnterEvent(QDragEnterEvent* event) override;
    void dropEvent(QDropEvent* event) override;

private:
    void makeDocks();
    void makeFileMenu();
    void makeViewMenu();
    QAction* makeDockAction(const DockEntry& entry, QDockWidget* dock);
    void makeToolBar();
    void begin(const QString& way);
    void savePicture();
    void copyCommand();
    void setTheme(const QString& name);
    void about();
    void showKeys();
    void showWelcome();
    void closeWelcome();
    void placeDocks();
    void refreshTitle();
    bool mayDiscard();
    bool saveTo(const QString& path);
    bool save();
    void restoreLayout();

    Desk& desk_;
    QString settings_file_;
    ObjectView* view_ = nullptr;
    Welcome* welcome_ = nullptr;
    std::vector<QAction*> tools_;                      ///< of the tool bar, from the left
    std::vector<std::pair<QAction*, QString>> icons_;  ///< drawn again when the theme changes
    std::vector<QDockWidget*> docks_;                  ///< in the order of docks()
    std::vector<QAction*> dock_actions_;               ///< in the same order
};

}  // namespace searchlight::gui
