#include "minimize.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "chooser.h"

namespace nuvo::fuzz {
namespace {

using Words = std::vector<std::string>;

Words words_of(const std::string& value) {
    Words words;
    for (std::size_t i = 0; i < value.size();) {
        const std::size_t begin = value.find_first_not_of(" ,", i);
        if (begin == std::string::npos) break;
        i = std::min(value.find_first_of(" ,", begin), value.size());
        words.push_back(value.substr(begin, i - begin));
    }
    return words;
}

std::string joined(const Words& words) {
    std::string all;
    for (const std::string& word : words) all += (all.empty() ? "" : " ") + word;
    return all;
}

std::optional<double> number(const std::string& word) {
    double value = 0;
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (stop != end || error != std::errc()) return std::nullopt;
    return value;
}

// `value` with that many significant digits.
std::string rounded(double value, int digits) {
    char shown[40];
    const auto end =
        std::to_chars(shown, shown + sizeof shown, value, std::chars_format::scientific, digits - 1)
            .ptr;
    return text(*number(std::string(shown, end)));
}

// Simpler words in place of one, the simplest first.
Words simpler(const std::string& word) {
    const std::optional<double> value = number(word);
    if (!value || *value == 0) return {};
    Words all{"0", "1", "-1"};
    for (const int digits : {1, 2, 3, 6, 9, 12}) all.push_back(rounded(*value, digits));
    std::erase_if(all, [&](const std::string& w) { return w.size() >= word.size() && w != "0"; });
    if (word == "1") return {"0"};
    return all;
}

// All elements but the root, in an order in which indices of earlier ones stay.
void collect(Element& element, std::vector<Element*>& all) {
    for (Element& child : element.children) {
        all.push_back(&child);
        collect(child, all);
    }
}

class Minimizer {
  public:
    Minimizer(Document document, const Shows& shows, int trials)
        : document_(std::move(document)), shows_(shows), trials_(trials) {}

    Document run() {
        for (bool progress = true; progress && trials_ > 0;) {
            progress = drop_rays();
            progress = cut_elements() || progress;
            progress = cut_attributes() || progress;
            progress = shrink_picture() || progress;
            progress = cut_lists() || progress;
            progress = simplify_numbers() || progress;
        }
        return document_;
    }

  private:
    // Takes the changed document if it shows the finding.
    bool take(Document changed) {
        if (trials_-- <= 0 || !shows_(changed)) return false;
        document_ = std::move(changed);
        return true;
    }
    // The i-th element below the root of a document; null beyond the last.
    static Element* element(Document& document, std::size_t i) {
        std::vector<Element*> all;
        collect(document.root, all);
        return i < all.size() ? all[i] : nullptr;
    }

    bool drop_rays() {
        bool progress = false;
        for (std::size_t chunk = document_.rays.size(); chunk > 0; chunk /= 2)
            for (std::size_t i = 0; i + chunk <= document_.rays.size();) {
                Document changed = document_;
                const auto begin = changed.rays.begin() + static_cast<std::ptrdiff_t>(i);
                changed.rays.erase(begin, begin + static_cast<std::ptrdiff_t>(chunk));
                if (take(std::move(changed)))
                    progress = true;
                else
                    ++i;
            }
        return progress;
    }

    // Leaves whole subtrees out, or puts an element's children in its place.
    bool cut_elements() {
        bool progress = false;
        for (std::size_t i = 0; trials_ > 0;) {
            Document without = document_;
            std::vector<Element*> path = path_to(without.root, i);
            if (path.empty()) break;
            Element& parent = *path[0];
            const auto place = parent.children.begin() + (path[1] - parent.children.data());
            const Element cut = *place;
            const auto next = parent.children.erase(place);
            if (take(without)) {
                progress = true;
                continue;
            }
            if (!cut.children.empty()) {
                parent.children.insert(next, cut.children.begin(), cut.children.end());
                if (take(std::move(without))) {
                    progress = true;
                    continue;
                }
            }
            ++i;
        }
        return progress;
    }

    // The parent of the i-th element below `root`, and the element; empty beyond the last.
    static std::vector<Element*> path_to(Element& root, std::size_t i) {
        for (Element& child : root.children) {
            if (i == 0) return {&root, &child};
            const std::size_t below = count_elements(child) - 1;
            if (i <= below) return path_to(child, i - 1);
            i -= below + 1;
        }
        return {};
    }

    bool cut_attributes() {
        bool progress = false;
        for (std::size_t i = 0; element(document_, i) != nullptr && trials_ > 0; ++i)
            for (std::size_t k = 0; k < element(document_, i)->attributes.size();) {
                Document changed = document_;
                auto& list = element(changed, i)->attributes;
                list.erase(list.begin() + static_cast<std::ptrdiff_t>(k));
                if (take(std::move(changed)))
                    progress = true;
                else
                    ++k;
            }
        return progress;
    }

    bool shrink_picture() {
        bool progress = false;
        for (const auto& [w, h] : {std::pair{1, 1}, {2, 1}, {1, 2}, {4, 3}, {16, 9}}) {
            const Resolution& now = document_.resolution;
            if (w * h >= now.width * now.height) break;
            Document changed = document_;
            changed.resolution = {w, h};
            if (take(std::move(changed))) {
                progress = true;
                break;
            }
        }
        return progress;
    }

    // Parts of long lists: faces of meshes, points that nothing names.
    bool cut_lists() {
        bool progress = false;
        for (std::size_t i = 0; element(document_, i) != nullptr && trials_ > 0; ++i)
            for (std::size_t k = 0; k < element(document_, i)->attributes.size(); ++k) {
                const std::size_t size = words_at(i, k).size();
                if (size <= 4) continue;
                for (std::size_t chunk = size / 2; chunk >= 3; chunk /= 2)
                    for (std::size_t begin = 0; begin + chunk <= words_at(i, k).size();) {
                        Words words = words_at(i, k);
                        const auto first = words.begin() + static_cast<std::ptrdiff_t>(begin);
                        words.erase(first, first + static_cast<std::ptrdiff_t>(chunk));
                        if (put(i, k, words))
                            progress = true;
                        else
                            begin += chunk;
                    }
            }
        return progress;
    }

    bool simplify_numbers() {
        bool progress = false;
        for (std::size_t i = 0; element(document_, i) != nullptr && trials_ > 0; ++i)
            for (std::size_t k = 0; k < element(document_, i)->attributes.size(); ++k)
                for (std::size_t n = 0; n < words_at(i, k).size(); ++n)
                    for (const std::string& word : simpler(words_at(i, k)[n])) {
                        Words words = words_at(i, k);
                        words[n] = word;
                        if (!put(i, k, words)) continue;
                        progress = true;
                        break;
                    }
        for (std::size_t r = 0; r < document_.rays.size(); ++r)
            for (std::size_t n = 0; n < words_of(document_.rays[r]).size(); ++n)
                for (const std::string& word : simpler(words_of(document_.rays[r])[n])) {
                    Words words = words_of(document_.rays[r]);
                    words[n] = word;
                    if (words[3] == "0" && words[4] == "0" && words[5] == "0") continue;
                    Document changed = document_;
                    changed.rays[r] = joined(words);
                    if (!take(std::move(changed))) continue;
                    progress = true;
                    break;
                }
        return progress;
    }

    Words words_at(std::size_t i, std::size_t k) {
        return words_of(element(document_, i)->attributes[k].value);
    }
    bool put(std::size_t i, std::size_t k, const Words& words) {
        Document changed = document_;
        element(changed, i)->attributes[k].value = joined(words);
        return take(std::move(changed));
    }

    Document document_;
    const Shows& shows_;
    int trials_;
};

}  // namespace

Document minimized(Document document, const Shows& shows, int trials) {
    return Minimizer(std::move(document), shows, trials).run();
}

}  // namespace nuvo::fuzz
