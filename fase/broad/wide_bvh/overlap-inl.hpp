/// What overlaps a box, all pairs, and refitting. Included inside the namespace of each target.

struct NodeToOpen {
    std::uint32_t node;
};

bool visit_overlapping(const Forest& forest, const Aabb& box, Found visit) {
    const WideBox mine(box);
    const Node* const nodes = forest.nodes.data();
    LocalStack<NodeToOpen, 256> open;
    for (std::size_t i = forest.roots.size(); i-- > 0;) open.push({forest.roots[i]});
    while (!open.empty()) {
        const Node& node = nodes[open.pop().node];
        std::uint32_t bits = mine.overlaps(node);
        open.make_room(width);
        while (bits != 0) {
            const std::uint32_t child = take_bit(bits);
            const std::uint32_t link = node.link[child];
            if ((link & leaf_bit) == 0) {
                open.push_if(true, {link});
            } else if (link != none && !visit(link & ~leaf_bit, node.box(child))) {
                return false;
            }
        }
    }
    return true;
}

struct MeetingToOpen {
    std::uint32_t a, b;
};
using Meetings = LocalStack<MeetingToOpen, 1024>;

/// A simultaneous descent into two forests, or into one twice.
template <bool AwakeOnly> class Descent {
public:
    Descent(const Forest& one, const Forest& two, PairSink& sink)
        : one_(one), two_(two), a_nodes_(one.nodes.data()), b_nodes_(two.nodes.data()), sink_(sink) {}

    HWY_INLINE void open(Meetings& meetings) {
        const MeetingToOpen meeting = meetings.pop();
        meetings.make_room(width * width);
        const bool a_is_box = (meeting.a & leaf_bit) != 0, b_is_box = (meeting.b & leaf_bit) != 0;
        if (a_is_box) {
            const Place a = meeting.a & ~leaf_bit;
            const WideBox box(a_nodes_[a / width], a % width);
            row(meetings, a, meeting.b, box.overlaps(b_nodes_[meeting.b]));
        } else if (b_is_box) {
            const Place b = meeting.b & ~leaf_bit;
            std::uint32_t rows = WideBox(b_nodes_[b / width], b % width).overlaps(a_nodes_[meeting.a]);
            while (rows != 0) {
                const std::uint32_t i = take_bit(rows);
                one_meets_one(meetings, place_of(meeting.a, i), b);
            }
        } else if (&one_ == &two_ && meeting.a == meeting.b) {
            against_itself(meetings, meeting.a);
        } else {
            const Node &a = a_nodes_[meeting.a], &b = b_nodes_[meeting.b];
            // Children of a that do not reach the whole of b need no look at its children.
            const Place whole = two_.parents[meeting.b];
            std::uint32_t rows = whole == none ? 0xff : WideBox(b_nodes_[whole / width], whole % width).overlaps(a);
            while (rows != 0) {
                const std::uint32_t i = take_bit(rows);
                row(meetings, place_of(meeting.a, i), meeting.b, WideBox(a, i).overlaps(b));
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
    HWY_INLINE void against_itself(Meetings& meetings, std::uint32_t index) {
        const Node& node = a_nodes_[index];
        for (std::uint32_t i = 0; i < width; ++i) {
            if (node.link[i] == none) continue;
            const std::uint32_t later = 0xfeu << i;
            row(meetings, place_of(index, i), index, WideBox(node, i).overlaps(node) & later);
            if (!node.is_leaf(i) && (!AwakeOnly || awake(one_, place_of(index, i)) != 0))
                meetings.push({node.link[i], node.link[i]});
        }
    }
    /// A child of `one` and those children of a node of `two` that it overlaps.
    HWY_INLINE void row(Meetings& meetings, Place a, std::uint32_t b_node, std::uint32_t bits) {
        if constexpr (AwakeOnly) {
            if (awake(one_, a) == 0) bits &= two_.awake[b_node];
        }
        while (bits != 0) add(meetings, a, place_of(b_node, take_bit(bits)));
    }
    HWY_INLINE void one_meets_one(Meetings& meetings, Place a, Place b) {
        if constexpr (AwakeOnly) {
            if ((awake(one_, a) | awake(two_, b)) == 0) return;
        }
        add(meetings, a, b);
    }
    HWY_INLINE void add(Meetings& meetings, Place a, Place b) {
        const std::uint32_t p = a_nodes_[a / width].link[a % width], q = b_nodes_[b / width].link[b % width];
        if ((p & q & leaf_bit) != 0) {
            if (p != q) sink_.add(p & ~leaf_bit, q & ~leaf_bit);
            return;
        }
        meetings.push({(p & leaf_bit) != 0 ? leaf_bit | a : p, (q & leaf_bit) != 0 ? leaf_bit | b : q});
    }
};

template <bool AwakeOnly> void descend_as(const Forest& one, const Forest& two, Meeting start, PairSink& sink) {
    Descent<AwakeOnly> descent(one, two, sink);
    Meetings meetings;
    meetings.push({start.a, start.b});
    while (!meetings.empty()) descent.open(meetings);
}

void descend(const Forest& one, const Forest& two, Meeting start, bool awake_only, PairSink& sink) {
    awake_only ? descend_as<true>(one, two, start, sink) : descend_as<false>(one, two, start, sink);
}

void open_one(const Forest& one, const Forest& two, Meeting start, PairSink& sink, std::vector<Meeting>& left) {
    Descent<false> descent(one, two, sink);
    Meetings meetings;
    meetings.push({start.a, start.b});
    descent.open(meetings);
    for (std::size_t i = 0; i < meetings.size(); ++i) left.push_back({meetings.data()[i].a, meetings.data()[i].b});
}

/// From the last node to the first: children stand behind their parents.
double refit_nodes(Forest& forest, std::uint32_t begin) {
    double cost = 0;
    for (std::size_t at = forest.nodes.size(); at-- > begin;) {
        const Place parent = forest.parents[at];
        if (parent == none) continue;
        const Node& node = forest.nodes[at];
        float whole[6];
        for (int i = 0; i < 6; ++i) {
            V some = load(node.plane[i]);
            for (int k = lanes; k < width; k += lanes) {
                const V more = load(node.plane[i] + k);
                some = i < 3 ? hn::Min(some, more) : hn::Max(some, more);
            }
            whole[i] = hn::GetLane(i < 3 ? hn::MinOfLanes(Floats(), some) : hn::MaxOfLanes(Floats(), some));
        }
        const Aabb box{{whole[0], whole[1], whole[2]}, {whole[3], whole[4], whole[5]}};
        forest.nodes[parent / width].set_box(parent % width, box);
        cost += cost_of(box);
    }
    return cost;
}
