#include "gui/editor/bssrdf_highlighter.h"

#include <QSet>

#include "gui/editor/bssrdf_names.h"
#include "gui/window/theme.h"

namespace searchlight::gui {

namespace {

// What goes on in the next line.
enum State { plain = 0, in_info = 1, in_parameters = 2, in_comment = 4 };

QTextCharFormat formatOf(const char* dark, const char* light, bool is_dark, bool bold = false) {
    QTextCharFormat format;
    format.setForeground(QColor(QLatin1String(is_dark ? dark : light)));
    if (bold) format.setFontWeight(QFont::DemiBold);
    return format;
}

}  // namespace

BssrdfHighlighter::BssrdfHighlighter(Theme& theme, QTextDocument* document)
    : QSyntaxHighlighter(document), theme_(theme) {
    takeColors();
    connect(&theme_, &Theme::changed, this, [this] {
        takeColors();
        rehighlight();
    });
}

// Each at least 4.5 : 1 against its background.
void BssrdfHighlighter::takeColors() {
    const bool dark = theme_.isDark();
    words_[static_cast<int>(Word::type)] = formatOf("#7fb4ff", "#0b57b0", dark);
    words_[static_cast<int>(Word::keyword)] = formatOf("#d7a0ff", "#7a2fb0", dark);
    words_[static_cast<int>(Word::builtin)] = formatOf("#6fd0c8", "#00696b", dark);
    words_[static_cast<int>(Word::physics)] = formatOf("#f0c674", "#8a5a00", dark);
    words_[static_cast<int>(Word::global)] = formatOf("#ff9d7e", "#b23c17", dark);
    comment_ = formatOf("#8e97a3", "#5f6b78", dark);
    comment_.setFontItalic(true);
    number_ = formatOf("#b5d68c", "#3b6b12", dark);
    section_ = formatOf("#7fb4ff", "#0b57b0", dark, true);
    attribute_ = formatOf("#d7a0ff", "#7a2fb0", dark);
}

BssrdfHighlighter::Word BssrdfHighlighter::wordOf(const QString& word) {
    static const QHash<QString, Word> known = [] {
        QHash<QString, Word> made;
        const BssrdfNames& names = bssrdfNames();
        for (const QString& name : names.physics) made[name] = Word::physics;
        for (const QString& name : names.builtins) made[name] = Word::builtin;
        for (const QString& name : names.types) made[name] = Word::type;
        for (const QString& name : names.keywords) made[name] = Word::keyword;
        for (const QString& name : names.globals) made[name] = Word::global;
        return made;
    }();
    return known.value(word, Word::other);
}

void BssrdfHighlighter::highlightBlock(const QString& text) {
    int state = std::max(previousBlockState(), 0);
    const auto words = [&](qsizetype from, const auto& format_of) {
        for (qsizetype i = from; i < text.size();) {
            if (!text[i].isLetter() && text[i] != QLatin1Char('_')) {
                ++i;
                continue;
            }
            qsizetype end = i;
            while (end < text.size() && (text[end].isLetterOrNumber() || text[end] == QLatin1Char('_'))) ++end;
            if (const QTextCharFormat* format = format_of(text.mid(i, end - i)))
                setFormat(static_cast<int>(i), static_cast<int>(end - i), *format);
            i = end;
        }
    };
    const QString trimmed = text.trimmed();
    if (trimmed.startsWith(QLatin1String("::")) && !(state & in_comment)) {
        setFormat(0, static_cast<int>(text.size()), section_);
        state = plain;
        if (trimmed.contains(QLatin1String("begin"))) {
            if (trimmed.endsWith(QLatin1String("info"))) state = in_info;
            if (trimmed.endsWith(QLatin1String("parameters"))) state = in_parameters;
        }
        return setCurrentBlockState(state);
    }
    if (currentBlock().blockNumber() == 0) {
        words(0, [&](const QString& word) { return bssrdfNames().attributes.contains(word) ? &attribute_ : nullptr; });
        return setCurrentBlockState(plain);
    }
    if (state == in_info) {
        // The key, then free text.
        qsizetype end = 0;
        while (end < text.size() && !text[end].isSpace()) ++end;
        setFormat(0, static_cast<int>(end), attribute_);
        return setCurrentBlockState(state);
    }
    const QString line_comment = QLatin1String(state == in_parameters ? "#" : "//");
    words(0, [&](const QString& word) {
        const Word kind = wordOf(word);
        return kind == Word::other ? nullptr : &words_[static_cast<int>(kind)];
    });
    for (qsizetype i = 0; i < text.size(); ++i) {
        if (state & in_comment) {
            const qsizetype end = text.indexOf(QLatin1String("*/"), i);
            const qsizetype stop = end < 0 ? text.size() : end + 2;
            setFormat(static_cast<int>(i), static_cast<int>(stop - i), comment_);
            if (end >= 0) state &= ~in_comment;
            i = stop - 1;
        } else if (text.mid(i).startsWith(line_comment)) {
            setFormat(static_cast<int>(i), static_cast<int>(text.size() - i), comment_);
            break;
        } else if (text.mid(i, 2) == QLatin1String("/*")) {
            state |= in_comment;
            --i;
        } else if (text[i].isDigit() &&
                   (i == 0 || !(text[i - 1].isLetterOrNumber() || text[i - 1] == QLatin1Char('_')))) {
            qsizetype end = i;
            while (end < text.size() && (text[end].isLetterOrNumber() || text[end] == QLatin1Char('.') ||
                                         (text[end] == QLatin1Char('-') && text[end - 1] == QLatin1Char('e'))))
                ++end;
            setFormat(static_cast<int>(i), static_cast<int>(end - i), number_);
            i = end - 1;
        }
    }
    setCurrentBlockState(state);
}

}  // namespace searchlight::gui
