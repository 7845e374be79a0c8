// The window: the object view in the middle, docks around it, menus, and the status bar.
#pragma once

#include <QMainWindow>
#include <QStringList>

#include "gui/window/desk.h"

class QActionGroup;
class QLabel;

namespace searchlight::gui {

class ObjectView;
class NoticeBar;

class MainWindow : public QMainWindow {
    Q_OBJECT

public:
    /// `settings_file`: where layout and theme are remembered; empty: nowhere.
    explicit MainWindow(Desk& desk, QString settings_file = {}, QWidget* parent = nullptr);
    ~MainWindow() override;

    /// Workspaces, scenes, shapes, pictures of light, models: what a path is, its ending says. Faults are notices.
    void openPaths(const QStringList& paths);

    /// The dock of that id (docks.cpp); null: none.
    QDockWidget* dock(const QString& id) const;

protected:
    void closeEvent(QCloseEvent* event) override;
    void dragEnterEvent(QDragEnterEvent* event) override;
    void dropEvent(QDropEvent* event) override;

private:
    void makeDocks();
    void makeMenus();
    void makeToolBar();
    void makeStatusBar();
    void placeDocks();
    void refreshTitle();
    bool mayDiscard();
    bool saveTo(const QString& path);
    bool save();
    void restoreLayout();

    Desk& desk_;
    QString settings_file_;
    ObjectView* view_ = nullptr;
    NoticeBar* notices_ = nullptr;
    std::vector<QDockWidget*> docks_;  ///< in the order of docks()
};

}  // namespace searchlight::gui
