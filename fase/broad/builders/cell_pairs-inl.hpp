/// SIMD tests of one box against a block of boxes, and the pair searches in the leaves of a tree. Included inside the
/// namespace of each SIMD target, hence no #pragma once and no includes.

/// The boxes that a pass tests against each other. A search for all pairs is one pass All; a search for pairs with an
/// awake box consists of the two other passes.
enum class Pass { All, AwakeAgainstAll, RestingAgainstAwake };

inline bool is_query(Pass pass, const std::uint8_t* awake, std::uint32_t place) {
    return pass == Pass::All || (awake[place] != 0) == (pass == Pass::AwakeAgainstAll);
}
inline bool is_candidate(Pass pass, const std::uint8_t* awake, std::uint32_t place) {
    return pass != Pass::RestingAgainstAwake || awake[place] != 0;
}

/// Up to `capacity` boxes in structure-of-arrays layout.
class Block {
public:
    static constexpr std::uint32_t capacity = 512;

    [[nodiscard]] std::uint32_t size() const { return size_; }
    [[nodiscard]] bool full() const { return size_ == capacity; }
    [[nodiscard]] std::uint32_t place(std::uint32_t i) const { return place_[i]; }
    void clear() { size_ = 0; }
    void add(const Aabb& box, std::uint32_t place) {
        lo_x_[size_] = box.lo.x;
        lo_y_[size_] = box.lo.y;
        lo_z_[size_] = box.lo.z;
        hi_x_[size_] = box.hi.x;
        hi_y_[size_] = box.hi.y;
        hi_z_[size_] = box.hi.z;
        place_[size_++] = place;
    }
    /// Adds a pair for each box of begin .. end - 1 that overlaps `box`.
    HWY_INLINE void test(const Aabb& box, Proxy proxy, std::uint32_t begin, std::uint32_t end, const Proxy* proxies,
                         PairSink& sink) const {
        const auto lo_x = hn::Set(Tag(), box.lo.x), lo_y = hn::Set(Tag(), box.lo.y), lo_z = hn::Set(Tag(), box.lo.z);
        const auto hi_x = hn::Set(Tag(), box.hi.x), hi_y = hn::Set(Tag(), box.hi.y), hi_z = hn::Set(Tag(), box.hi.z);
        for (; begin < end; begin += lanes) {
            const auto x = hn::And(hn::Le(lo_x, load(hi_x_, begin)), hn::Le(load(lo_x_, begin), hi_x));
            const auto y = hn::And(hn::Le(lo_y, load(hi_y_, begin)), hn::Le(load(lo_y_, begin), hi_y));
            const auto z = hn::And(hn::Le(lo_z, load(hi_z_, begin)), hn::Le(load(lo_z_, begin), hi_z));
            std::uint32_t hits = bits_of(hn::And(hn::And(x, y), z));
            if (end - begin < lanes) hits &= (1u << (end - begin)) - 1;
            for (; hits != 0; hits &= hits - 1)
                sink.add(proxy, proxies[place_[begin + static_cast<std::uint32_t>(std::countr_zero(hits))]]);
        }
    }

private:
    using Tag = hn::CappedTag<float, 16>;
    static constexpr std::uint32_t lanes = static_cast<std::uint32_t>(hn::MaxLanes(Tag()));
    using Row = std::array<float, capacity + lanes>;  // loads may read one vector past the end

    alignas(64) Row lo_x_{}, lo_y_{}, lo_z_{}, hi_x_{}, hi_y_{}, hi_z_{};
    std::array<std::uint32_t, capacity> place_{};
    std::uint32_t size_ = 0;

    static HWY_INLINE hn::Vec<Tag> load(const Row& row, std::uint32_t at) { return hn::LoadU(Tag(), row.data() + at); }
    static HWY_INLINE std::uint32_t bits_of(hn::Mask<Tag> mask) {
        std::uint8_t bytes[8] = {};
        hn::StoreMaskBits(Tag(), mask, bytes);
        return bytes[0] | static_cast<std::uint32_t>(bytes[1]) << 8;
    }
};

/// Pairs within leaves that hold every box that overlaps their cell.
class PairsInLeaves {
public:
    PairsInLeaves(const CellTree& tree, std::uint32_t dimensions, PairSink& sink)
        : boxes_(tree.boxes().data()),
          proxies_(tree.proxies().data()),
          references_(tree.references().data()),
          awake_(tree.awake().data()),
          owned_mark_((1u << dimensions) - 1),
          sink_(sink) {}

    void run(const CellTree::Leaf& leaf, bool awake_only) {
        std::uint32_t i = leaf.first_reference;
        for (std::uint32_t mark = 0; mark < owned_mark_; ++mark) {
            groups_[mark].begin = i;
            while (i < leaf.first_reference + leaf.references && references_[i].mark() == mark) ++i;
            groups_[mark].end = i;
        }
        if (!awake_only) return run_pass<Pass::All>(leaf);
        run_pass<Pass::AwakeAgainstAll>(leaf);
        run_pass<Pass::RestingAgainstAwake>(leaf);
    }

private:
    struct Range {
        std::uint32_t begin = 0, end = 0;
    };
    const Aabb* boxes_;
    const Proxy* proxies_;
    const CellTree::Reference* references_;
    const std::uint8_t* awake_;
    std::uint32_t owned_mark_;
    PairSink& sink_;
    std::array<Range, 8> groups_;    // ranges of the leaf's references, by mark
    std::array<Range, 8> in_block_;  // the part of each range that is in the block
    Block block_;

    /// Owned boxes begin in the leaf on all axes, so all of their pairs are reported here. Two references are a pair of
    /// this leaf only if each begins on the axes on which the other does not.
    template <Pass pass> void run_pass(const CellTree::Leaf& leaf) {
        std::uint32_t next_owned = leaf.first, next_reference = leaf.first_reference;
        const std::uint32_t owned_end = leaf.first + leaf.owned, reference_end = leaf.first_reference + leaf.references;
        while (next_owned < owned_end || next_reference < reference_end) {
            block_.clear();
            for (; next_owned < owned_end && !block_.full(); ++next_owned)
                if (is_candidate(pass, awake_, next_owned)) block_.add(boxes_[next_owned], next_owned);
            const std::uint32_t owned = block_.size();
            for (std::uint32_t mark = 0; mark < owned_mark_; ++mark) {
                in_block_[mark].begin = block_.size();
                for (; next_reference < groups_[mark].end && !block_.full(); ++next_reference) {
                    const std::uint32_t place = references_[next_reference].place();
                    if (is_candidate(pass, awake_, place)) block_.add(boxes_[place], place);
                }
                in_block_[mark].end = block_.size();
            }
            test_owned<pass>(leaf, owned);
            test_references<pass>();
        }
    }
    /// The first `owned` boxes of the block are owned by the leaf.
    template <Pass pass> void test_owned(const CellTree::Leaf& leaf, std::uint32_t owned) {
        std::uint32_t later = 0;
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.owned; ++i) {
            while (later < owned && block_.place(later) <= i) ++later;
            if (is_query(pass, awake_, i)) block_.test(boxes_[i], proxies_[i], later, block_.size(), proxies_, sink_);
        }
    }
    template <Pass pass> void test_references() {
        for (std::uint32_t one = 1; one < owned_mark_; ++one) {
            for (std::uint32_t other = one + 1; other < owned_mark_; ++other) {
                const Range candidates = in_block_[other];
                if ((one | other) != owned_mark_ || candidates.begin == candidates.end) continue;
                for (std::uint32_t i = groups_[one].begin; i < groups_[one].end; ++i) {
                    const std::uint32_t place = references_[i].place();
                    if (!is_query(pass, awake_, place)) continue;
                    block_.test(boxes_[place], proxies_[place], candidates.begin, candidates.end, proxies_, sink_);
                }
            }
        }
    }
};

/// Pairs of a leaf with itself and the leaves after it, found by a traversal that prunes with the bounds of nodes.
class PairsNearLeaves {
public:
    PairsNearLeaves(const CellTree& tree, PairSink& sink)
        : tree_(tree),
          boxes_(tree.boxes().data()),
          proxies_(tree.proxies().data()),
          awake_(tree.awake().data()),
          sink_(sink) {}

    void run(std::uint32_t at, bool awake_only) {
        if (!awake_only) return run_pass<Pass::All>(at);
        run_pass<Pass::AwakeAgainstAll>(at);
        if (tree_.nodes()[tree_.leaves()[at].node].awake) run_pass<Pass::RestingAgainstAwake>(at);
    }

private:
    const CellTree& tree_;
    const Aabb* boxes_;
    const Proxy* proxies_;
    const std::uint8_t* awake_;
    PairSink& sink_;
    Block block_;

    template <Pass pass> void run_pass(std::uint32_t at) {
        const CellTree::Leaf& leaf = tree_.leaves()[at];
        const Aabb bounds = tree_.owned_bounds()[leaf.node];
        std::uint32_t next = leaf.first;
        while (next < leaf.first + leaf.owned) {
            block_.clear();
            for (; next < leaf.first + leaf.owned && !block_.full(); ++next)
                if (is_candidate(pass, awake_, next)) block_.add(boxes_[next], next);
            if (block_.size() != 0) test_later<pass>(at, bounds);
        }
    }
    template <Pass pass> void test_later(std::uint32_t at, const Aabb& bounds) {
        const CellTree::Node* nodes = tree_.nodes().data();
        const Aabb* owned_bounds = tree_.owned_bounds().data();
        LocalStack<std::uint32_t, 128> open;
        open.push(CellTree::root);
        while (!open.empty()) {
            const CellTree::Node& node = nodes[open.pop()];
            if (node.is_leaf()) {
                test_leaf<pass>(tree_.leaves()[node.leaf_begin], node.leaf_begin == at, bounds);
                continue;
            }
            const auto end = node.first_child + static_cast<std::uint32_t>(std::popcount(node.children));
            open.reserve_more(16);
            for (std::uint32_t child = node.first_child; child < end; ++child) {
                const Aabb& box = owned_bounds[child];
                const int overlapping = int(nodes[child].leaf_end > at) & int(box.lo.x <= bounds.hi.x) &
                                        int(bounds.lo.x <= box.hi.x) & int(box.lo.y <= bounds.hi.y) &
                                        int(bounds.lo.y <= box.hi.y) & int(box.lo.z <= bounds.hi.z) &
                                        int(bounds.lo.z <= box.hi.z);
                open.push_if(overlapping != 0 && (pass != Pass::AwakeAgainstAll || nodes[child].awake), child);
            }
        }
    }
    template <Pass pass> void test_leaf(const CellTree::Leaf& leaf, bool is_same, const Aabb& bounds) {
        std::uint32_t later = 0;
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.owned; ++i) {
            if (is_same)
                while (later < block_.size() && block_.place(later) <= i) ++later;
            if (is_query(pass, awake_, i) && overlaps(boxes_[i], bounds))
                block_.test(boxes_[i], proxies_[i], later, block_.size(), proxies_, sink_);
        }
    }
};
