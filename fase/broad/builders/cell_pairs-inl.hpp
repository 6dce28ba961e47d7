/// One box against a block of boxes, and which boxes of a tree's leaves have to be tested so. Included inside the
/// namespace of each target, hence no #pragma once and no includes.

/// Of which boxes a pass tests pairs. A search for all pairs takes All, one that leaves out pairs of two that rest is
/// the sum of two passes.
enum class Pass { All, AwakeAgainstAll, RestingAgainstAwake };

inline bool asks(Pass pass, const std::uint8_t* awake, std::uint32_t place) {
    return pass == Pass::All || (awake[place] != 0) == (pass == Pass::AwakeAgainstAll);
}
inline bool answers(Pass pass, const std::uint8_t* awake, std::uint32_t place) {
    return pass != Pass::RestingAgainstAwake || awake[place] != 0;
}

/// Up to `capacity` boxes, each bound in a row of its own.
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
    /// Reports each box of begin .. end - 1 that overlaps `box`.
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
    using Row = std::array<float, capacity + lanes>;  // a vector's length past the end may be read

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

/// Pairs within leaves that hold whatever overlaps their cell.
class PairsInLeaves {
public:
    PairsInLeaves(const CellTree& tree, std::uint32_t dimensions, PairSink& sink)
        : boxes_(tree.boxes().data()),
          proxies_(tree.proxies().data()),
          visitors_(tree.visitors().data()),
          awake_(tree.awake().data()),
          owned_mark_((1u << dimensions) - 1),
          sink_(sink) {}

    void run(const CellTree::Leaf& leaf, bool awake_only) {
        std::uint32_t i = leaf.first_visitor;
        for (std::uint32_t mark = 0; mark < owned_mark_; ++mark) {
            groups_[mark].begin = i;
            while (i < leaf.first_visitor + leaf.visitors && visitors_[i].mark() == mark) ++i;
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
    const CellTree::Visitor* visitors_;
    const std::uint8_t* awake_;
    std::uint32_t owned_mark_;
    PairSink& sink_;
    std::array<Range, 8> groups_;    // of the leaf's visitors, by mark
    std::array<Range, 8> in_block_;  // the same, as far as they are in the block
    Block block_;

    /// Owned boxes begin in the leaf along all axes, so all of their pairs count. Of two visitors each must begin along
    /// the axes along which the other does not.
    template <Pass pass> void run_pass(const CellTree::Leaf& leaf) {
        std::uint32_t next_owned = leaf.first, next_visitor = leaf.first_visitor;
        const std::uint32_t owned_end = leaf.first + leaf.owned, visitor_end = leaf.first_visitor + leaf.visitors;
        while (next_owned < owned_end || next_visitor < visitor_end) {
            block_.clear();
            for (; next_owned < owned_end && !block_.full(); ++next_owned)
                if (answers(pass, awake_, next_owned)) block_.add(boxes_[next_owned], next_owned);
            const std::uint32_t owned = block_.size();
            for (std::uint32_t mark = 0; mark < owned_mark_; ++mark) {
                in_block_[mark].begin = block_.size();
                for (; next_visitor < groups_[mark].end && !block_.full(); ++next_visitor) {
                    const std::uint32_t place = visitors_[next_visitor].place();
                    if (answers(pass, awake_, place)) block_.add(boxes_[place], place);
                }
                in_block_[mark].end = block_.size();
            }
            test_owned<pass>(leaf, owned);
            test_visitors<pass>();
        }
    }
    /// `owned` boxes of the block are the leaf's own.
    template <Pass pass> void test_owned(const CellTree::Leaf& leaf, std::uint32_t owned) {
        std::uint32_t later = 0;
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.owned; ++i) {
            while (later < owned && block_.place(later) <= i) ++later;
            if (asks(pass, awake_, i)) block_.test(boxes_[i], proxies_[i], later, block_.size(), proxies_, sink_);
        }
    }
    template <Pass pass> void test_visitors() {
        for (std::uint32_t one = 1; one < owned_mark_; ++one) {
            for (std::uint32_t other = one + 1; other < owned_mark_; ++other) {
                const Range there = in_block_[other];
                if ((one | other) != owned_mark_ || there.begin == there.end) continue;
                for (std::uint32_t i = groups_[one].begin; i < groups_[one].end; ++i) {
                    const std::uint32_t place = visitors_[i].place();
                    if (!asks(pass, awake_, place)) continue;
                    block_.test(boxes_[place], proxies_[place], there.begin, there.end, proxies_, sink_);
                }
            }
        }
    }
};

/// Pairs of a leaf and those that come after it, found through the boxes around what nodes hold.
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
        const Aabb around = tree_.contents()[leaf.node];
        std::uint32_t next = leaf.first;
        while (next < leaf.first + leaf.owned) {
            block_.clear();
            for (; next < leaf.first + leaf.owned && !block_.full(); ++next)
                if (answers(pass, awake_, next)) block_.add(boxes_[next], next);
            if (block_.size() != 0) test_later<pass>(at, around);
        }
    }
    template <Pass pass> void test_later(std::uint32_t at, const Aabb& around) {
        const CellTree::Node* nodes = tree_.nodes().data();
        const Aabb* contents = tree_.contents().data();
        LocalStack<std::uint32_t, 128> open;
        open.push(CellTree::root);
        while (!open.empty()) {
            const CellTree::Node& node = nodes[open.pop()];
            if (node.is_leaf()) {
                test_leaf<pass>(tree_.leaves()[node.leaf_begin], node.leaf_begin == at, around);
                continue;
            }
            const auto end = node.first_child + static_cast<std::uint32_t>(std::popcount(node.children));
            open.make_room(16);
            for (std::uint32_t child = node.first_child; child < end; ++child) {
                const Aabb& box = contents[child];
                const int wanted = int(nodes[child].leaf_end > at) & int(box.lo.x <= around.hi.x) &
                                   int(around.lo.x <= box.hi.x) & int(box.lo.y <= around.hi.y) &
                                   int(around.lo.y <= box.hi.y) & int(box.lo.z <= around.hi.z) &
                                   int(around.lo.z <= box.hi.z);
                open.push_if(wanted != 0 && (pass != Pass::AwakeAgainstAll || nodes[child].awake), child);
            }
        }
    }
    template <Pass pass> void test_leaf(const CellTree::Leaf& leaf, bool is_same, const Aabb& around) {
        std::uint32_t later = 0;
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.owned; ++i) {
            if (is_same)
                while (later < block_.size() && block_.place(later) <= i) ++later;
            if (asks(pass, awake_, i) && overlaps(boxes_[i], around))
                block_.test(boxes_[i], proxies_[i], later, block_.size(), proxies_, sink_);
        }
    }
};
