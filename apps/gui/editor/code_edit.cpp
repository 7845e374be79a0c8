#include "gui/editor/code_edit.h"

#include <QAbstractItemView>
#include <QCompleter>
#include <QHelpEvent>
#include <QPainter>
#include <QScrollBar>
#include <QStringListModel>
#include <QTextBlock>
#include <QToolTip>
#include <algorithm>

#include "gui/editor/bssrdf_names.h"
#include "gui/window/theme.h"

namespace searchlight::gui {

namespace {

constexpr int kIndent = 4;

class Margin : public QWidget {
public:
    explicit Margin(CodeEdit* edit) : QWidget(edit), edit_(edit) {}
    QSize sizeHint() const override { return {edit_->marginWidth(), 0}; }

protected:
    void paintEvent(QPaintEvent* event) override { edit_->paintMargin(event); }

private:
    CodeEdit* edit_;
};

bool isWord(QChar c) { return c.isLetterOrNumber() || c == QLatin1Char('_'); }

}  // namespace

CodeEdit::CodeEdit(Theme& theme, QWidget* parent)
    : QPlainTextEdit(parent), theme_(theme), margin_(new Margin(this)), completer_(new QCompleter(this)) {
    setLineWrapMode(NoWrap);
    setAccessibleName(tr("Text of the model"));
    completer_->setModel(new QStringListModel(bssrdfNames().all(), completer_));
    completer_->setWidget(this);
    completer_->setCaseSensitivity(Qt::CaseInsensitive);
    completer_->setCompletionMode(QCompleter::PopupCompletion);
    connect(completer_, qOverload<const QString&>(&QCompleter::activated), this, &CodeEdit::complete);
    const auto dress = [this] {
        setFont(theme_.codeFont());
        setTabStopDistance(kIndent * QFontMetricsF(font()).horizontalAdvance(QLatin1Char(' ')));
        setViewportMargins(marginWidth(), 0, 0, 0);
        mark();
    };
    connect(&theme_, &Theme::changed, this, dress);
    connect(this, &QPlainTextEdit::blockCountChanged, this, [this] { setViewportMargins(marginWidth(), 0, 0, 0); });
    connect(this, &QPlainTextEdit::cursorPositionChanged, this, &CodeEdit::mark);
    connect(this, &QPlainTextEdit::updateRequest, this, [this](const QRect& rect, int dy) {
        if (dy != 0)
            margin_->scroll(0, dy);
        else
            margin_->update(0, rect.y(), margin_->width(), rect.height());
    });
    dress();
}

int CodeEdit::marginWidth() const {
    const auto digits = std::max<qsizetype>(3, QString::number(blockCount()).size());
    return static_cast<int>(digits) * fontMetrics().horizontalAdvance(QLatin1Char('9')) + 2 * Space::s;
}

void CodeEdit::resizeEvent(QResizeEvent* event) {
    QPlainTextEdit::resizeEvent(event);
    margin_->setGeometry(contentsRect().left(), contentsRect().top(), marginWidth(), contentsRect().height());
}

void CodeEdit::paintMargin(QPaintEvent* event) {
    QPainter painter(margin_);
    const Colors& colors = theme_.colors();
    painter.fillRect(event->rect(), colors.panel);
    painter.setFont(font());
    const int current = textCursor().blockNumber();
    for (QTextBlock block = firstVisibleBlock(); block.isValid(); block = block.next()) {
        const QRectF place = blockBoundingGeometry(block).translated(contentOffset());
        if (place.top() > event->rect().bottom()) break;
        const bool wrong = problem_ && problem_->line == block.blockNumber() + 1;
        painter.setPen(wrong ? colors.error : block.blockNumber() == current ? colors.text : colors.muted);
        painter.drawText(QRectF(0, place.top(), margin_->width() - Space::s, place.height()),
                         Qt::AlignRight | Qt::AlignTop, QString::number(block.blockNumber() + 1));
        if (wrong) painter.fillRect(QRectF(0, place.top(), 3, place.height()), colors.error);
    }
}

void CodeEdit::setProblem(std::optional<Error> problem) {
    problem_ = std::move(problem);
    setAccessibleDescription(problem_ ? QString::fromUtf8(problem_->what()) : QString());
    mark();
    margin_->update();
    viewport()->update();
}

void CodeEdit::mark() {
    QList<QTextEdit::ExtraSelection> marks;
    QTextEdit::ExtraSelection line;
    QColor tint = theme_.colors().accent;
    tint.setAlphaF(0.08f);
    line.format.setBackground(tint);
    line.format.setProperty(QTextFormat::FullWidthSelection, true);
    line.cursor = textCursor();
    line.cursor.clearSelection();
    marks << line;
    if (problem_ && problem_->line > 0) {
        const QTextBlock block = document()->findBlockByNumber(problem_->line - 1);
        if (block.isValid()) {
            QTextEdit::ExtraSelection wave;
            wave.format.setUnderlineStyle(QTextCharFormat::WaveUnderline);
            wave.format.setUnderlineColor(theme_.colors().error);
            const QString text = block.text();
            // The word at the column; without one, the line's text.
            qsizetype from = 0, to = text.size();
            while (from < to && text[from].isSpace()) ++from;
            if (problem_->column > 0 && problem_->column <= text.size()) {
                from = problem_->column - 1;
                to = from;
                while (to < text.size() && isWord(text[to])) ++to;
                to = std::max(to, from + 1);
            }
            wave.cursor = QTextCursor(block);
            wave.cursor.setPosition(block.position() + static_cast<int>(from));
            wave.cursor.setPosition(block.position() + static_cast<int>(to), QTextCursor::KeepAnchor);
            marks << wave;
        }
    }
    setExtraSelections(marks);
    margin_->update();
}

void CodeEdit::paintEvent(QPaintEvent* event) {
    QPlainTextEdit::paintEvent(event);
    if (!problem_ || problem_->line <= 0) return;
    const QTextBlock block = document()->findBlockByNumber(problem_->line - 1);
    if (!block.isValid()) return;
    const QRectF place = blockBoundingGeometry(block).translated(contentOffset());
    QPainter painter(viewport());
    painter.setFont(theme_.smallFont());
    painter.setPen(theme_.colors().error);
    const double left = place.left() + fontMetrics().horizontalAdvance(block.text()) + 3 * Space::s;
    const double room = viewport()->width() - left - Space::s;
    const QString message = QString::fromStdString(problem_->message).section(QLatin1Char('\n'), 0, 0);
    // Too little room beside the line: the bar below says it.
    if (room < 80) return;
    painter.drawText(QRectF(left, place.top(), room, place.height()), Qt::AlignLeft | Qt::AlignVCenter,
                     painter.fontMetrics().elidedText(message, Qt::ElideRight, static_cast<int>(room)));
}

void CodeEdit::goTo(int line, int column) {
    const QTextBlock block = document()->findBlockByNumber(std::max(line, 1) - 1);
    if (!block.isValid()) return;
    QTextCursor cursor(block);
    if (column > 0) cursor.setPosition(block.position() + std::min(column - 1, block.length() - 1));
    setTextCursor(cursor);
    ensureCursorVisible();
    setFocus();
}

QString CodeEdit::wordAtCursor() const {
    const QString line = textCursor().block().text();
    const int end = textCursor().positionInBlock();
    int from = end;
    while (from > 0 && isWord(line[from - 1])) --from;
    return line.mid(from, end - from);
}

QStringList CodeEdit::completions() const {
    const QString word = wordAtCursor();
    QStringList found;
    for (const QString& name : bssrdfNames().all())
        if (!word.isEmpty() && name.startsWith(word, Qt::CaseInsensitive) && name != word) found << name;
    return found;
}

void CodeEdit::complete(const QString& name) {
    QTextCursor cursor = textCursor();
    cursor.movePosition(QTextCursor::Left, QTextCursor::KeepAnchor, static_cast<int>(wordAtCursor().size()));
    cursor.insertText(name);
    setTextCursor(cursor);
}

void CodeEdit::offerCompletion(bool asked) {
    const QString word = wordAtCursor();
    if ((!asked && word.size() < 3) || completions().isEmpty()) {
        completer_->popup()->hide();
        return;
    }
    completer_->setCompletionPrefix(word);
    completer_->popup()->setCurrentIndex(completer_->completionModel()->index(0, 0));
    QRect place = cursorRect();
    place.translate(marginWidth(), 0);
    place.setWidth(completer_->popup()->sizeHintForColumn(0) +
                   completer_->popup()->verticalScrollBar()->sizeHint().width() + Space::l);
    completer_->complete(place);
}

// Of the selected lines, or of a single one where nothing is selected.
void CodeEdit::indent(bool more) {
    QTextCursor cursor = textCursor();
    if (more && !cursor.hasSelection()) {
        cursor.insertText(QString(kIndent - cursor.positionInBlock() % kIndent, QLatin1Char(' ')));
        return;
    }
    const int last = document()->findBlock(cursor.selectionEnd()).blockNumber();
    cursor.beginEditBlock();
    for (QTextBlock block = document()->findBlock(cursor.selectionStart());
         block.isValid() && block.blockNumber() <= last; block = block.next()) {
        QTextCursor at(block);
        if (more)
            at.insertText(QString(kIndent, QLatin1Char(' ')));
        else
            for (int i = 0; i < kIndent && block.text().startsWith(QLatin1Char(' ')); ++i) at.deleteChar();
    }
    cursor.endEditBlock();
}

void CodeEdit::toggleComment() {
    QTextCursor cursor = textCursor();
    const QTextBlock first = document()->findBlock(cursor.selectionStart());
    const int last = document()->findBlock(cursor.selectionEnd()).blockNumber();
    const bool off = first.text().trimmed().startsWith(QLatin1String("//"));
    cursor.beginEditBlock();
    for (QTextBlock block = first; block.isValid() && block.blockNumber() <= last; block = block.next()) {
        QTextCursor at(block);
        const qsizetype slash = block.text().indexOf(QLatin1String("//"));
        if (!off) {
            at.insertText(QStringLiteral("// "));
        } else if (slash >= 0) {
            at.setPosition(block.position() + static_cast<int>(slash));
            const int count = block.text().mid(slash, 3) == QLatin1String("// ") ? 3 : 2;
            for (int i = 0; i < count; ++i) at.deleteChar();
        }
    }
    cursor.endEditBlock();
}

void CodeEdit::keyPressEvent(QKeyEvent* event) {
    if (completer_->popup()->isVisible()) switch (event->key()) {
            case Qt::Key_Enter:
            case Qt::Key_Return:
            case Qt::Key_Escape:
            case Qt::Key_Tab:
            case Qt::Key_Backtab: event->ignore(); return;
            default: break;
        }
    if (event->matches(QKeySequence::Save)) {
        emit saveWished();
        return;
    }
    const bool control = event->modifiers() & Qt::ControlModifier;
    if (control && event->key() == Qt::Key_Space) return offerCompletion(true);
    if (control && event->key() == Qt::Key_Slash) return toggleComment();
    if (event->key() == Qt::Key_Tab) return indent(true);
    if (event->key() == Qt::Key_Backtab) return indent(false);
    if (event->key() == Qt::Key_Return && !control) {
        const QString line = textCursor().block().text().left(textCursor().positionInBlock());
        qsizetype spaces = 0;
        while (spaces < line.size() && line[spaces] == QLatin1Char(' ')) ++spaces;
        if (line.trimmed().endsWith(QLatin1Char('{'))) spaces += kIndent;
        textCursor().insertText(QLatin1Char('\n') + QString(spaces, QLatin1Char(' ')));
        ensureCursorVisible();
        return;
    }
    if (event->text() == QLatin1String("}") && textCursor().block().text().trimmed().isEmpty()) indent(false);
    QPlainTextEdit::keyPressEvent(event);
    if (!event->text().isEmpty() && isWord(event->text().front()))
        offerCompletion(false);
    else
        completer_->popup()->hide();
}

// The signature and comment of the function under the pointer.
bool CodeEdit::event(QEvent* event) {
    // Save is the window's word for its workspace: here it means the text.
    if (event->type() == QEvent::ShortcutOverride && static_cast<QKeyEvent*>(event)->matches(QKeySequence::Save)) {
        event->accept();
        return true;
    }
    if (event->type() != QEvent::ToolTip) return QPlainTextEdit::event(event);
    const auto* help = static_cast<QHelpEvent*>(event);
    QTextCursor cursor = cursorForPosition(viewport()->mapFromGlobal(help->globalPos()));
    cursor.select(QTextCursor::WordUnderCursor);
    QString text = physicsHelp(cursor.selectedText());
    if (problem_ && problem_->line == cursor.blockNumber() + 1) text = QString::fromUtf8(problem_->what());
    QToolTip::showText(help->globalPos(), text, this);
    return true;
}

}  // namespace searchlight::gui
