/// Packs rectangles onto pages: tries one set of rules after another and keeps the best result.
#include "fase/atlas/packer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "fase/atlas/packers/kd_tree.hpp"
#include "fase/atlas/packers/tries.hpp"

namespace fase::atlas {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::int64_t no_limit = std::numeric_limits<std::int64_t>::max();

/// Returns the cell of a rectangle: itself, its extruded edges, and the padding at its right and below. Pages are
/// enlarged by the padding, because a cell at their edge needs none.
Size cell_of(Size size, const PackOptions& options) {
    const int margin = 2 * options.extrude + options.padding;
    return {size.width + margin, size.height + margin};
}

Result<void> check(std::span<const Size> sizes, const PackOptions& options, std::size_t first_number) {
    const auto refuse = [](const char* what, auto found, const char* expected) {
        return Error{Status::BadArgument, what, fmt::format("found {}; expected {}", found, expected), {}};
    };
    if (options.max_side < 1 || options.max_side > max_page_side)
        return refuse("PackOptions.max_side", options.max_side, "1 to 65536");
    if (options.padding < 0 || options.padding > 1024)
        return refuse("PackOptions.padding", options.padding, "0 to 1024");
    if (options.extrude < 0 || options.extrude > 1024)
        return refuse("PackOptions.extrude", options.extrude, "0 to 1024");
    if (options.tries < 0) return refuse("PackOptions.tries", options.tries, "0 or more");
    if (!(options.budget_ms >= 0)) return refuse("PackOptions.budget_ms", options.budget_ms, "0 or more");
    int side = options.max_side;
    if (options.power_of_two)
        while ((side & (side - 1)) != 0) side &= side - 1;
    const int most = side - 2 * options.extrude;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        const Size size = sizes[i];
        if (size.width >= 1 && size.height >= 1 && size.width <= most && size.height <= most) continue;
        const bool large = size.width > most || size.height > most;
        return Error{Status::OutOfRange, fmt::format("rectangle {}", first_number + i),
                     fmt::format("found {} x {} pixels; expected 1 x 1 to {} x {}", size.width, size.height,
                                 std::max(most, 0), std::max(most, 0)),
                     large ? "allow larger pages" : ""};
    }
    return {};
}

/// The best result for a page so far.
struct Filled {
    Size page;  ///< of cells: enlarged by the padding
    std::vector<PlacedKind> placed;
    std::int64_t left = no_limit;  ///< pixels of the rectangles that did not fit
    std::string rule;
};

/// Runs the tries of one packing, page by page.
class Packer {
public:
    Packer(const PackOptions& options, std::vector<Kind> kinds, std::vector<std::uint32_t> counts,
           Clock::time_point start)
        : options_(options), filler_(std::move(kinds), options.rotate), counts_(std::move(counts)), start_(start) {}

    Packing pack(std::span<const Size> cells, std::vector<std::vector<std::uint32_t>> of_kind);

private:
    [[nodiscard]] std::int64_t area_left() const {
        std::int64_t area = 0;
        for (std::size_t i = 0; i < counts_.size(); ++i) area += area_of(filler_.kinds()[i]) * counts_[i];
        return area;
    }
    [[nodiscard]] double spent_ms() const {
        return std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
    }
    /// Returns whether the budget allows another try for this page; with a time budget, one as long as the longest so
    /// far.
    [[nodiscard]] bool may_try() const {
        if (options_.tries > 0) return page_tries_ < options_.tries;
        return spent_ms() + longest_try_ms_ < page_end_ms_;
    }
    /// Tries rules on a page and keeps the result if it is better: fewer pixels left, or a smaller page. Returns
    /// whether everything fitted.
    bool attempt(std::uint32_t number, Size page, std::int64_t max_lost);
    /// Returns a lower bound for the side of a square for all remaining rectangles, from their area and their longest
    /// side.
    [[nodiscard]] int min_side(std::int64_t area) const;
    void fill_page(std::int64_t area);
    void fill_square(std::int64_t area, int limit);
    void fill_power_of_two(std::int64_t area, int limit);
    void fill_partly(Size page);

    const PackOptions& options_;
    PageFiller filler_;
    std::vector<std::uint32_t> counts_;
    Clock::time_point start_;
    double page_end_ms_ = 0, longest_try_ms_ = 0;
    int page_tries_ = 0, tries_ = 0;
    Filled best_;
    std::vector<PlacedKind> placed_;
};

bool Packer::attempt(std::uint32_t number, Size page, std::int64_t max_lost) {
    const TryRules rules = rules_of(number, options_.method);
    ++page_tries_;
    ++tries_;
    const double begin_ms = spent_ms();
    const std::int64_t left = filler_.fill(rules, page, counts_, max_lost, placed_);
    longest_try_ms_ = std::max(longest_try_ms_, spent_ms() - begin_ms);
    // A try with a limit was aborted if something is left, so its result is incomplete.
    if (left > 0 && max_lost != no_limit) return false;
    const bool better = left < best_.left || (left == best_.left && area_of(page) < area_of(best_.page));
    if (better) {
        best_.page = page;
        best_.placed.swap(placed_);
        best_.left = left;
        best_.rule = text_of(rules);
    }
    return left == 0;
}

int Packer::min_side(std::int64_t area) const {
    std::int64_t side = static_cast<std::int64_t>(std::sqrt(static_cast<double>(area)));
    while (side * side < area) ++side;
    while (side > 1 && (side - 1) * (side - 1) >= area) --side;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
        if (counts_[i] == 0) continue;
        side = std::max<std::int64_t>({side, filler_.kinds()[i].width, filler_.kinds()[i].height});
    }
    return static_cast<int>(std::min<std::int64_t>(side, std::numeric_limits<int>::max() / 2));
}

/// Fills a page that need not hold everything with the rules that leave the least.
void Packer::fill_partly(Size page) {
    std::uint32_t number = 0;
    do {
        if (attempt(number, page, no_limit)) return;
        ++number;
    } while (may_try());
}

void Packer::fill_square(std::int64_t area, int limit) {
    const int least = min_side(area);
    const auto square = [](int side) { return Size{side, side}; };
    const auto attempt_square = [&](std::uint32_t number, int side) {
        return attempt(number, square(side), std::int64_t{side} * side - area);
    };
    // Increase the side in growing steps, with the first rules, until everything fits.
    for (int side = least, step = 1; side <= limit && best_.left != 0; side += step, step *= 2) {
        if (attempt_square(0, side)) break;
    }
    if (best_.left != 0) {
        fill_partly(square(limit));
        if (best_.left != 0) return;
    }
    // Decrease the side: try the rules in turn at a smaller side, and halve the step after each failure.
    int step = std::max(1, (best_.page.width - least + 1) / 2);
    for (std::uint32_t number = 0; best_.page.width > least && may_try(); ++number) {
        step = std::min(step, best_.page.width - least);
        // Repeat the same rules while they succeed.
        while (attempt_square(number, best_.page.width - step) && may_try()) {
            step = std::min(step, best_.page.width - least);
            if (step == 0) return;
        }
        step = std::max(1, step / 2);
    }
}

void Packer::fill_power_of_two(std::int64_t area, int limit) {
    const int padding = options_.padding;
    constexpr std::uint32_t rules_per_size = 16;
    const int longest = min_side(0);
    for (int side = 1; side + padding <= limit; side *= 2) {
        for (const int width : {side, 2 * side}) {
            const Size page{width + padding, side + padding};
            if (page.width > limit || area_of(page) < area || page.width < longest) continue;
            for (std::uint32_t number = 0; number < rules_per_size; ++number) {
                if (attempt(number, page, area_of(page) - area)) return;
                if (!may_try()) break;
            }
        }
    }
    int side = limit - padding;
    while ((side & (side - 1)) != 0) side &= side - 1;
    fill_partly({side + padding, side + padding});
}

void Packer::fill_page(std::int64_t area) {
    best_ = {};
    page_tries_ = 0;
    longest_try_ms_ = 0;
    const int limit = options_.max_side + options_.padding;
    // Divide the remaining time equally among the remaining pages.
    const double spent = spent_ms();
    const double pages = std::ceil(static_cast<double>(area) / (static_cast<double>(limit) * limit));
    page_end_ms_ = spent + std::max(0.0, options_.budget_ms - spent) / std::max(1.0, pages);
    if (options_.power_of_two) {
        fill_power_of_two(area, limit);
    } else {
        fill_square(area, limit);
    }
}

Packing Packer::pack(std::span<const Size> cells, std::vector<std::vector<std::uint32_t>> of_kind) {
    Packing packing;
    packing.places.resize(cells.size());
    for (std::int64_t area = area_left(); area > 0; area = area_left()) {
        fill_page(area);
        Size used;
        for (const PlacedKind& placed : best_.placed) {
            Size cell = filler_.kinds()[placed.kind];
            if (placed.rotated) std::swap(cell.width, cell.height);
            const std::uint32_t rectangle = of_kind[placed.kind].back();
            of_kind[placed.kind].pop_back();
            packing.places[rectangle] = {static_cast<std::uint32_t>(packing.pages.size()), placed.x + options_.extrude,
                                         placed.y + options_.extrude, cell.width != cells[rectangle].width};
            used = {std::max(used.width, placed.x + cell.width), std::max(used.height, placed.y + cell.height)};
            --counts_[placed.kind];
        }
        const Size page = options_.crop && !options_.power_of_two ? used : best_.page;
        if (packing.pages.empty()) packing.rule = best_.rule;
        packing.pages.push_back({page.width - options_.padding, page.height - options_.padding});
    }
    packing.tries = tries_;
    return packing;
}

}  // namespace

double Packing::occupancy(std::span<const Size> sizes) const {
    std::int64_t covered = 0, all = 0;
    for (const Size size : sizes) covered += area_of(size);
    for (const Size page : pages) all += area_of(page);
    return all == 0 ? 0 : static_cast<double>(covered) / static_cast<double>(all);
}

Result<Packing> pack(std::span<const Size> sizes, const PackOptions& options) {
    const Clock::time_point start = Clock::now();
    if (auto checked = check(sizes, options, 0); !checked) return checked.error();
    std::vector<Size> cells;
    cells.reserve(sizes.size());
    for (const Size size : sizes) cells.push_back(cell_of(size, options));
    // Equal cells are one kind. pack() takes rectangles from the back, so each kind lists them in descending order.
    const auto kind_of = [&](std::uint32_t i) {
        const Size cell = cells[i];
        return options.rotate && cell.width > cell.height ? Size{cell.height, cell.width} : cell;
    };
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order(cells.size());
    for (std::uint32_t i = 0; i < cells.size(); ++i) {
        const Size kind = kind_of(i);
        order[i] = {static_cast<std::uint64_t>(kind.width) << 32 | static_cast<std::uint32_t>(kind.height), ~i};
    }
    std::sort(order.begin(), order.end());
    std::vector<Kind> kinds;
    std::vector<std::uint32_t> counts;
    std::vector<std::vector<std::uint32_t>> of_kind;
    for (const auto& [key, inverse] : order) {
        const std::uint32_t i = ~inverse;
        if (kinds.empty() || kinds.back() != kind_of(i)) {
            kinds.push_back(kind_of(i));
            counts.push_back(0);
            of_kind.emplace_back();
        }
        ++counts.back();
        of_kind.back().push_back(i);
    }
    return Packer(options, std::move(kinds), std::move(counts), start).pack(cells, std::move(of_kind));
}

Result<void> add(Packing& packing, std::span<const Size> packed, std::span<const Size> added,
                 const PackOptions& options) {
    if (packed.size() != packing.places.size())
        return Error{Status::BadArgument,
                     "add",
                     fmt::format("found {} sizes; expected those of the {} packed rectangles", packed.size(),
                                 packing.places.size()),
                     {}};
    if (auto checked = check(added, options, packed.size()); !checked) return checked;
    const int padding = options.padding, extrude = options.extrude;
    std::vector<KdTree> trees;
    for (const Size page : packing.pages) trees.emplace_back(Size{page.width + padding, page.height + padding});
    for (std::size_t i = 0; i < packed.size(); ++i) {
        const Place& place = packing.places[i];
        Size cell = cell_of(packed[i], options);
        if (place.rotated) std::swap(cell.width, cell.height);
        if (place.page < trees.size())
            trees[place.page].occupy({place.x - extrude, place.y - extrude, cell.width, cell.height});
    }
    std::vector<std::uint32_t> order(added.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const auto key = [&](Size size) { return std::pair(std::max(size.width, size.height), area_of(size)); };
        return key(added[a]) > key(added[b]);
    });
    std::vector<Place> places(added.size());
    std::vector<std::uint32_t> others;
    std::vector<Size> other_sizes;
    for (const std::uint32_t i : order) {
        const Size cell = cell_of(added[i], options);
        bool done = false;
        for (std::uint32_t page = 0; page < trees.size() && !done; ++page) {
            const auto spot = trees[page].insert(cell, options.rotate);
            if (!spot) continue;
            places[i] = {page, spot->x + extrude, spot->y + extrude, spot->width != cell.width};
            done = true;
        }
        if (done) continue;
        others.push_back(i);
        other_sizes.push_back(added[i]);
    }
    if (!others.empty()) {
        Result<Packing> new_pages = pack(other_sizes, options);
        if (!new_pages) return new_pages.error();
        for (std::size_t i = 0; i < others.size(); ++i) {
            places[others[i]] = new_pages->places[i];
            places[others[i]].page += static_cast<std::uint32_t>(packing.pages.size());
        }
        packing.pages.insert(packing.pages.end(), new_pages->pages.begin(), new_pages->pages.end());
        packing.tries += new_pages->tries;
    }
    packing.places.insert(packing.places.end(), places.begin(), places.end());
    return {};
}

}  // namespace fase::atlas
