/// Overlap queries, all pairs, and refitting. Included inside the namespace of each SIMD target.

struct StackedNode {
    std::uint32_t node;
};

bool visit_overlapping(const Forest& forest, const Aabb& box, VisitOverlap visit) {
    const WideBox mine(box);
    const Node* const nodes = forest.nodes.data();
    LocalStack<StackedNode, 256> open;
    for (std::size_t i = forest.roots.size(); i-- > 0;) open.push({forest.roots[i]});
    while (!open.empty()) {
        const Node& node = nodes[open.pop().node];
        std::uint32_t bits = mine.overlaps(node);
        open.reserve_more(width);
        while (bits != 0) {
            const std::uint32_t child = take_bit(bits);
            const std::uint32_t link = node.link[child];
            if ((link & leaf_bit) == 0) {
                open.push_if(true, {link});
            } else if (link != no_index && !visit(link & ~leaf_bit, node.box(child))) {
                return false;
            }
        }
    }
    return true;
}

struct StackedPair {
    std::uint32_t a, b;
};
using PairStack = LocalStack<StackedPair, 1024>;

/// A simultaneous descent of two forests, or of one against itself.
template <bool AwakeOnly> class Descent {
public:
    Descent(const Forest& one, const Forest& two, PairSink& sink)
        : one_(one), two_(two), a_nodes_(one.nodes.data()), b_nodes_(two.nodes.data()), sink_(sink) {}

    HWY_INLINE void expand_top(PairStack& stack) {
        const StackedPair pair = stack.pop();
        stack.reserve_more(width * width);
        const bool a_is_box = (pair.a & leaf_bit) != 0, b_is_box = (pair.b & leaf_bit) != 0;
        if (a_is_box) {
            const Place a = pair.a & ~leaf_bit;
            const WideBox box(a_nodes_[a / width], a % width);
            row(stack, a, pair.b, box.overlaps(b_nodes_[pair.b]));
        } else if (b_is_box) {
            const Place b = pair.b & ~leaf_bit;
            std::uint32_t rows = WideBox(b_nodes_[b / width], b % width).overlaps(a_nodes_[pair.a]);
            while (rows != 0) {
                const std::uint32_t i = take_bit(rows);
                test_pair(stack, place_of(pair.a, i), b);
            }
        } else if (&one_ == &two_ && pair.a == pair.b) {
            against_itself(stack, pair.a);
        } else {
            const Node &a = a_nodes_[pair.a], &b = b_nodes_[pair.b];
            // Children of a that do not overlap the box of b need no test against the children of b.
            const Place b_place = two_.parents[pair.b];
            std::uint32_t rows =
                b_place == no_index ? 0xff : WideBox(b_nodes_[b_place / width], b_place % width).overlaps(a);
            while (rows != 0) {
                const std::uint32_t i = take_bit(rows);
                row(stack, place_of(pair.a, i), pair.b, WideBox(a, i).overlaps(b));
            }
        }
    }

private:
    const Forest& one_;
    const Forest& two_;
    const Node* const a_nodes_;
    const Node* const b_nodes_;
    PairSink& sink_;

    [[nodiscard]] std::uint32_t awake(const Forest& forest, Place place) const {
        return forest.awake[place / width] >> (place % width) & 1;
    }
    HWY_INLINE void against_itself(PairStack& stack, std::uint32_t index) {
        const Node& node = a_nodes_[index];
        for (std::uint32_t i = 0; i < width; ++i) {
            if (node.link[i] == no_index) continue;
            const std::uint32_t later = 0xfeu << i;
            row(stack, place_of(index, i), index, WideBox(node, i).overlaps(node) & later);
            if (!node.is_leaf(i) && (!AwakeOnly || awake(one_, place_of(index, i)) != 0))
                stack.push({node.link[i], node.link[i]});
        }
    }
    /// Adds a child of `one` with the children `bits` of a node of `two`, which it overlaps.
    HWY_INLINE void row(PairStack& stack, Place a, std::uint32_t b_node, std::uint32_t bits) {
        if constexpr (AwakeOnly) {
            if (awake(one_, a) == 0) bits &= two_.awake[b_node];
        }
        while (bits != 0) add(stack, a, place_of(b_node, take_bit(bits)));
    }
    HWY_INLINE void test_pair(PairStack& stack, Place a, Place b) {
        if constexpr (AwakeOnly) {
            if ((awake(one_, a) | awake(two_, b)) == 0) return;
        }
        add(stack, a, b);
    }
    HWY_INLINE void add(PairStack& stack, Place a, Place b) {
        const std::uint32_t p = a_nodes_[a / width].link[a % width], q = b_nodes_[b / width].link[b % width];
        if ((p & q & leaf_bit) != 0) {
            if (p != q) sink_.add(p & ~leaf_bit, q & ~leaf_bit);
            return;
        }
        stack.push({(p & leaf_bit) != 0 ? leaf_bit | a : p, (q & leaf_bit) != 0 ? leaf_bit | b : q});
    }
};

template <bool AwakeOnly> void descend_as(const Forest& one, const Forest& two, NodePair start, PairSink& sink) {
    Descent<AwakeOnly> descent(one, two, sink);
    PairStack stack;
    stack.push({start.a, start.b});
    while (!stack.empty()) descent.expand_top(stack);
}

void descend(const Forest& one, const Forest& two, NodePair start, bool awake_only, PairSink& sink) {
    awake_only ? descend_as<true>(one, two, start, sink) : descend_as<false>(one, two, start, sink);
}

void expand_node_pair(const Forest& one, const Forest& two, NodePair start, PairSink& sink,
                      std::vector<NodePair>& left) {
    Descent<false> descent(one, two, sink);
    PairStack stack;
    stack.push({start.a, start.b});
    descent.expand_top(stack);
    for (std::size_t i = 0; i < stack.size(); ++i) left.push_back({stack.data()[i].a, stack.data()[i].b});
}

/// Refits from the last node to the first, as children follow their parents.
double refit_nodes(Forest& forest, std::uint32_t begin) {
    double cost = 0;
    for (std::size_t at = forest.nodes.size(); at-- > begin;) {
        const Place parent = forest.parents[at];
        if (parent == no_index) continue;
        const Node& node = forest.nodes[at];
        float bounds[6];
        for (int i = 0; i < 6; ++i) {
            V result = load(node.plane[i]);
            for (int k = lanes; k < width; k += lanes) {
                const V next = load(node.plane[i] + k);
                result = i < 3 ? hn::Min(result, next) : hn::Max(result, next);
            }
            bounds[i] = hn::GetLane(i < 3 ? hn::MinOfLanes(Floats(), result) : hn::MaxOfLanes(Floats(), result));
        }
        const Aabb box{{bounds[0], bounds[1], bounds[2]}, {bounds[3], bounds[4], bounds[5]}};
        forest.nodes[parent / width].set_box(parent % width, box);
        cost += cost_of(box);
    }
    return cost;
}
