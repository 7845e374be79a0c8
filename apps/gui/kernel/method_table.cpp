#include "gui/kernel/method_table.h"

#include <QHeaderView>
#include <QSignalBlocker>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "gui/window/theme.h"
#include "kernel/signals.h"

namespace searchlight::gui {

namespace {

enum Column { name_column, passes_column, pictures_column, kernel_column, flip_column, ssim_column, first_signal };

// Sorts by its number; what is not known comes last.
class Cell : public QTableWidgetItem {
public:
    bool operator<(const QTableWidgetItem& other) const override {
        const QVariant a = data(Qt::UserRole), b = other.data(Qt::UserRole);
        if (a.isValid() && b.isValid()) return a.toDouble() < b.toDouble();
        return a.isValid() != b.isValid() ? a.isValid() : text() < other.text();
    }
    void set(double value, int decimals) {
        setData(Qt::UserRole, value);
        setText(QString::number(value, 'f', decimals));
    }
};

double overChannels(Rgb value) {
    double sum = 0;
    for (int c = 0; c < Rgb::channels; ++c) sum += value[c] * value[c];
    return std::sqrt(sum / Rgb::channels);
}

}  // namespace

MethodTable::MethodTable(Theme& theme, QWidget* parent) : QTableWidget(parent), theme_(theme) {
    const std::vector<NamedMethod> methods = namedMethods(17);
    QStringList titles{tr("Kernel"), tr("Passes"), tr("Pictures"), tr("Kernel space"), tr("FLIP"), tr("SSIM")};
    QStringList tips{tr("The method and its rank"),
                     tr("Two of each pair"),
                     tr("Root mean square error over seven pictures and three channels, light in [0, 1]"),
                     tr("Root mean square of the difference over that of the truth"),
                     tr("Mean over the pictures"),
                     tr("Mean over the pictures")};
    for (const Signal& signal : signals()) {
        titles << QString::fromLatin1(signal.name.data(), static_cast<int>(signal.name.size())).replace('_', ' ');
        titles.back()[0] = titles.back()[0].toUpper();
        tips << tr("Root mean square error: %1").arg(QString::fromUtf8(signal.shows.data()));
    }
    setColumnCount(static_cast<int>(titles.size()));
    setRowCount(static_cast<int>(methods.size()));
    setHorizontalHeaderLabels(titles);
    for (int i = 0; i < columnCount(); ++i) {
        horizontalHeaderItem(i)->setToolTip(tips[i]);
        horizontalHeaderItem(i)->setTextAlignment((i == name_column ? Qt::AlignLeft : Qt::AlignRight) |
                                                  Qt::AlignVCenter);
    }
    for (int r = 0; r < rowCount(); ++r)
        for (int i = 0; i < columnCount(); ++i) {
            auto* cell = new Cell;
            if (i == name_column) cell->setText(QString::fromStdString(methods[static_cast<std::size_t>(r)].name));
            if (i != name_column) cell->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
            setItem(r, i, cell);
        }
    verticalHeader()->hide();
    verticalHeader()->setDefaultSectionSize(24);
    horizontalHeader()->setHighlightSections(false);
    horizontalHeader()->setSortIndicatorShown(false);
    horizontalHeader()->setSectionsClickable(true);
    setColumnWidth(name_column, 116);
    setColumnWidth(passes_column, 60);
    setColumnWidth(pictures_column, 74);
    setColumnWidth(kernel_column, 98);
    for (int i = flip_column; i < columnCount(); ++i) setColumnWidth(i, 78);
    setFont(theme.smallFont());
    setShowGrid(false);
    setWordWrap(false);
    setSelectionBehavior(SelectRows);
    setSelectionMode(SingleSelection);
    setEditTriggers(NoEditTriggers);
    setTabKeyNavigation(false);
    setHorizontalScrollMode(ScrollPerPixel);
    connect(horizontalHeader(), &QHeaderView::sectionClicked, this, [this](int column) {
        horizontalHeader()->setSortIndicatorShown(true);
        sortItems(column, horizontalHeader()->sortIndicatorOrder());
    });
    connect(this, &QTableWidget::currentCellChanged, this, [this](int row, int, int before, int) {
        if (row >= 0 && row != before) emit chosen(item(row, name_column)->text());
    });
    connect(&theme_, &Theme::changed, this, &MethodTable::markBest);
}

int MethodTable::rowOf(const std::string& name) const {
    for (int r = 0; r < rowCount(); ++r)
        if (item(r, name_column)->text() == QString::fromStdString(name)) return r;
    return -1;
}

void MethodTable::setRow(const std::string& name, const JudgedKernel& judged, bool perceptual) {
    const int r = rowOf(name);
    if (r < 0) return;
    const auto set = [&](int column, double value, int decimals) {
        static_cast<Cell*>(item(r, column))->set(value, decimals);
    };
    set(passes_column, static_cast<double>(2 * judged.made.rank()), 0);
    set(pictures_column, judged.overall, 4);
    set(kernel_column, overChannels(judged.kernel_rms), 3);
    if (perceptual) {
        set(flip_column, judged.flip, 3);
        set(ssim_column, judged.ssim, 4);
    }
    for (std::size_t i = 0; i < judged.image_rms.size(); ++i)
        set(first_signal + static_cast<int>(i), Judge::overall({judged.image_rms[i]}), 4);
    markBest();
}

void MethodTable::clearRows() {
    for (int r = 0; r < rowCount(); ++r)
        for (int i = passes_column; i < columnCount(); ++i) {
            item(r, i)->setData(Qt::UserRole, {});
            item(r, i)->setText({});
        }
}

// The nearest in pictures at each count of passes.
void MethodTable::markBest() {
    std::map<double, std::pair<double, int>> best;
    for (int r = 0; r < rowCount(); ++r) {
        item(r, pictures_column)->setForeground(theme_.colors().text);
        const QVariant error = item(r, pictures_column)->data(Qt::UserRole);
        if (!error.isValid()) continue;
        auto& [least, row] = best.try_emplace(item(r, passes_column)->data(Qt::UserRole).toDouble(),
                                              std::numeric_limits<double>::infinity(), r)
                                 .first->second;
        if (error.toDouble() < least) {
            least = error.toDouble();
            row = r;
        }
    }
    for (const auto& [passes, found] : best) item(found.second, pictures_column)->setForeground(theme_.colors().good);
}

void MethodTable::setChosen(const std::string& name) {
    const QSignalBlocker quiet(this);
    if (const int r = rowOf(name); r >= 0 && r != currentRow()) setCurrentCell(r, name_column);
}

QString MethodTable::cell(const std::string& name, int column) const {
    const int r = rowOf(name);
    return r < 0 ? QString() : item(r, column)->text();
}

}  // namespace searchlight::gui
