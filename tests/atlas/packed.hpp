#pragma once
/// Checks the invariants of packings, with the broad phase as the reference for overlaps.
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "fase/atlas/packer.hpp"
#include "fase/broad/sweep_and_prune.hpp"

namespace fase::atlas {

/// Counts the pairs of areas on the same page that share a pixel, by a sweep over boxes.
inline std::size_t overlapping_pairs(const std::vector<std::pair<std::uint32_t, Area>>& areas) {
    broad::SweepAndPrune sweep;
    broad::Proxy number = 0;
    for (const auto& [page, area] : areas) {
        // Boxes are closed, so shrink them a little: neighbours then do not touch. Each page is a layer in z.
        const auto at = [](int pixel, float by) { return static_cast<float>(pixel) + by; };
        const float height = 2 * static_cast<float>(page);
        sweep.insert(number++, {{at(area.x, 0.25f), at(area.y, 0.25f), height},
                                {at(area.x + area.width, -0.25f), at(area.y + area.height, -0.25f), height + 1}});
    }
    sweep.commit();
    std::vector<broad::Pair> pairs;
    sweep.find_pairs(pairs);
    return pairs.size();
}

/// Returns the first violated invariant of a packing; "" if it is valid.
inline std::string problem_of(const Packing& packing, const std::vector<Size>& sizes, const PackOptions& options) {
    if (packing.places.size() != sizes.size()) return "not one place per rectangle";
    std::vector<std::pair<std::uint32_t, Area>> unpadded, padded;
    std::set<std::uint32_t> used;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        const Place& place = packing.places[i];
        const std::string name = "rectangle " + std::to_string(i);
        if (place.page >= packing.pages.size()) return name + " is on no page";
        if (place.rotated && !options.rotate) return name + " is rotated";
        used.insert(place.page);
        Area area{place.x - options.extrude, place.y - options.extrude, sizes[i].width + 2 * options.extrude,
                  sizes[i].height + 2 * options.extrude};
        if (place.rotated) std::swap(area.width, area.height);
        const Size page = packing.pages[place.page];
        if (area.x < 0 || area.y < 0 || area.x + area.width > page.width || area.y + area.height > page.height)
            return name + " extends beyond its page";
        area.width += options.padding;
        area.height += options.padding;
        padded.emplace_back(place.page, area);
    }
    if (overlapping_pairs(padded) > 0) return "rectangles overlap or are too close";
    if (used.size() != packing.pages.size()) return "a page is empty";
    for (const Size page : packing.pages) {
        if (page.width > options.max_side || page.height > options.max_side) return "a page is too large";
        const auto power = [](int n) { return (n & (n - 1)) == 0; };
        if (options.power_of_two && !(power(page.width) && power(page.height))) return "a side is not a power of two";
    }
    return "";
}

/// Reads a file with one "width height" per line.
inline std::vector<Size> read_sizes(const std::string& path) {
    std::ifstream file(path);
    std::vector<Size> sizes;
    for (Size size; file >> size.width >> size.height;) sizes.push_back(size);
    return sizes;
}

}  // namespace fase::atlas
