#pragma once
/// What every packing must be, judged by the broad phase.
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "fase/atlas/packer.hpp"
#include "fase/broad/sweep_and_prune.hpp"

namespace fase::atlas {

/// Pairs of areas of one page that share a pixel, found by a sweep over boxes.
inline std::size_t overlapping_pairs(const std::vector<std::pair<std::uint32_t, Area>>& areas) {
    broad::SweepAndPrune judge;
    broad::Proxy number = 0;
    for (const auto& [page, area] : areas) {
        // Closed boxes a little smaller than the pixels: neighbours do not touch. Pages lie above each other.
        const auto at = [](int pixel, float by) { return static_cast<float>(pixel) + by; };
        const float height = 2 * static_cast<float>(page);
        judge.insert(number++, {{at(area.x, 0.25f), at(area.y, 0.25f), height},
                                {at(area.x + area.width, -0.25f), at(area.y + area.height, -0.25f), height + 1}});
    }
    judge.commit();
    std::vector<broad::Pair> pairs;
    judge.find_pairs(pairs);
    return pairs.size();
}

/// What is wrong with a packing; "" when nothing is.
inline std::string problem_of(const Packing& packing, const std::vector<Size>& sizes, const PackOptions& options) {
    if (packing.places.size() != sizes.size()) return "not a place for each";
    std::vector<std::pair<std::uint32_t, Area>> own, padded;
    std::set<std::uint32_t> used;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        const Place& place = packing.places[i];
        const std::string name = "rectangle " + std::to_string(i);
        if (place.page >= packing.pages.size()) return name + " is on no page";
        if (place.rotated && !options.rotate) return name + " is turned";
        used.insert(place.page);
        Area area{place.x - options.extrude, place.y - options.extrude, sizes[i].width + 2 * options.extrude,
                  sizes[i].height + 2 * options.extrude};
        if (place.rotated) std::swap(area.width, area.height);
        const Size page = packing.pages[place.page];
        if (area.x < 0 || area.y < 0 || area.x + area.width > page.width || area.y + area.height > page.height)
            return name + " reaches out of its page";
        area.width += options.padding;
        area.height += options.padding;
        padded.emplace_back(place.page, area);
    }
    if (overlapping_pairs(padded) > 0) return "rectangles overlap or are too near";
    if (used.size() != packing.pages.size()) return "a page is empty";
    for (const Size page : packing.pages) {
        if (page.width > options.max_side || page.height > options.max_side) return "a page is too large";
        const auto power = [](int n) { return (n & (n - 1)) == 0; };
        if (options.power_of_two && !(power(page.width) && power(page.height))) return "a side is no power of two";
    }
    return "";
}

/// "width height" a line.
inline std::vector<Size> read_sizes(const std::string& path) {
    std::ifstream file(path);
    std::vector<Size> sizes;
    for (Size size; file >> size.width >> size.height;) sizes.push_back(size);
    return sizes;
}

}  // namespace fase::atlas
