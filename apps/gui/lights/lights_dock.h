// What shines on the object, and what stands around it.
#pragma once

#include <QWidget>
#include <functional>
#include <vector>

#include "gui/window/desk.h"

class QLabel;
class QToolButton;
class QVBoxLayout;

namespace searchlight::gui {

class LightsDock : public QWidget {
    Q_OBJECT

public:
    explicit LightsDock(Desk& desk, QWidget* parent = nullptr);

private:
    QWidget* makeModes();
    QWidget* makeSurroundings();
    void choose(int mode);
    void rebuild();
    void refresh();
    QWidget* makeCard(std::size_t index);
    void addPicture(QVBoxLayout* column, std::size_t index, bool filter);
    QString askForPicture(const QString& title);

    Desk& desk_;
    std::vector<QToolButton*> modes_;
    QVBoxLayout* cards_;
    std::string built_for_;  ///< kinds and pictures of the lights
    std::vector<std::function<void()>> refresh_cards_, refresh_rest_;
};

QWidget* makeLightsDock(Desk& desk);

}  // namespace searchlight::gui
