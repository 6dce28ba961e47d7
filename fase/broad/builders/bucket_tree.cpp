/// Distributes boxes to the cells of quadtree and octree, top-down.
#include "fase/broad/builders/bucket_tree.hpp"

#include "fase/broad/builders/cell_pairs.hpp"

namespace fase::broad {
namespace {

/// Packs three (or two) steps of 15 bits in fields of 16 bits, so that one subtraction compares all axes. The highest
/// bit of each field is a guard bit; the highest field of the word is free.
constexpr std::uint64_t guards = 0x8000'8000'8000;
template <class Steps> std::uint64_t packed(const Steps& steps) {
    std::uint64_t word = 0;
    for (std::size_t a = 0; a < steps.size(); ++a) word |= std::uint64_t{steps[a]} << (16 * a);
    return word;
}
/// Sets bit 16a where the a-th step is at least that of `limits`. The guard bits and the free field of `limits` are 0.
constexpr std::uint64_t no_less(std::uint64_t steps, std::uint64_t limits) {
    return (((steps | guards) - limits) & guards) >> 15;
}

/// The children that a box enters, as a bit mask. Bits 2a and 2a + 1 of the index tell whether its lower and upper
/// corner are above the split on the a-th axis.
constexpr std::array<std::uint8_t, 64> children_by_sides = [] {
    std::array<std::uint8_t, 64> children{};
    for (std::uint32_t sides = 0; sides < children.size(); ++sides) {
        std::uint32_t mask = 0xff;
        if ((sides & 1) != 0) mask &= 0xaa;
        if ((sides & 2) == 0) mask &= 0x55;
        if ((sides & 4) != 0) mask &= 0xcc;
        if ((sides & 8) == 0) mask &= 0x33;
        if ((sides & 16) != 0) mask &= 0xf0;
        if ((sides & 32) == 0) mask &= 0x0f;
        children[sides] = static_cast<std::uint8_t>(mask);
    }
    return children;
}();

/// Byte k of an entry is bit k of its index.
constexpr std::array<std::uint64_t, 256> byte_per_bit = [] {
    std::array<std::uint64_t, 256> bytes{};
    for (std::size_t mask = 0; mask < bytes.size(); ++mask)
        for (std::size_t bit = 0; bit < 8; ++bit) bytes[mask] |= std::uint64_t{mask >> bit & 1} << (8 * bit);
    return bytes;
}();

}  // namespace

template <int Dim> void BucketTree<Dim>::rebuild() {
    const std::span<const Move> rows = this->store_.regular();
    this->frame_ = CellFrame<Dim>(axes_, declared_, rows);
    if (rows.empty()) return this->tree_.clear();
    this->tree_.begin();
    if (records_.size() < rows.size()) records_.resize(rows.size());
    if (place_.size() < rows.size()) place_.resize(rows.size());
    for (std::uint32_t row = 0; row < rows.size(); ++row) {
        const Aabb& box = rows[row].box;
        records_[row] = {packed(this->frame_.steps_of(box.lo)) | std::uint64_t{row} << 48,
                         packed(this->frame_.steps_of(box.hi)) | std::uint64_t{row >> 16} << 48};
    }
    const auto count = static_cast<std::uint32_t>(rows.size());
    tasks_.clear();
    tasks_.push_back({.node = CellTree::root, .begin = 0, .end = count, .spare = (max_entries - 1) * count});
    while (!tasks_.empty()) {
        const Task task = tasks_.back();
        tasks_.pop_back();
        if (!try_split(task)) make_leaf(task);
    }
    this->tree_.finish();
}

/// Counts the records that enter each child. Stores the child masks of all records in masks_.
template <int Dim> auto BucketTree<Dim>::count_children(const Task& task) -> Counts {
    Steps middle{};
    for (std::size_t a = 0; a < Dim; ++a)
        middle[a] = static_cast<std::uint16_t>((task.path.begin(a) + task.path.end(a)) / 2);
    const std::uint64_t cut = packed(middle);
    const std::uint32_t count = task.end - task.begin;
    if (masks_.size() < count) masks_.resize(count);
    Counts counts{};
    for (std::uint32_t first = 0; first < count; first += 255) {
        const std::uint32_t end = std::min(count, first + 255);
        std::uint64_t sums = 0;  // one byte per child
        for (std::uint32_t i = first; i < end; ++i) {
            const Record& record = records_[task.begin + i];
            const std::uint64_t sides = no_less(record.lo, cut) | no_less(record.hi, cut) << 1;
            constexpr std::uint64_t gather = 1ull << 32 | 1ull << 18 | 1ull << 4;  // moves bits 0, 16, 32 to 32, 34, 36
            constexpr std::uint64_t all_sides = (1u << 2 * Dim) - 1;
            const std::uint32_t mask = children_by_sides[(sides * gather >> 32) & all_sides];
            masks_[i] = static_cast<std::uint8_t>(mask);
            sums += byte_per_bit[mask];
        }
        for (std::uint32_t child = 0; child < child_count; ++child) counts[child] += sums >> (8 * child) & 0xff;
    }
    return counts;
}

/// Returns whether a split into `entries` records saves enough pair tests.
template <int Dim>
bool BucketTree<Dim>::is_worthwhile(const Task& task, const Counts& counts, std::uint64_t entries) const {
    const std::uint64_t before = task.end - task.begin, more = entries - before;
    if (more == 0) return true;
    if (more > task.spare) return false;
    if (more <= before / 16) return true;  // a few large boxes must not prevent the split of a cluster
    std::uint64_t tests = 0;
    for (const std::uint64_t count : counts) tests += count * count;
    return tests + limits_.capacity * more < before * before;
}

template <int Dim> bool BucketTree<Dim>::try_split(const Task& task) {
    const std::uint32_t count = task.end - task.begin;
    if (count <= limits_.capacity || task.path.depth >= limits_.max_depth) return false;
    const Counts counts = count_children(task);
    std::uint64_t entries = 0;
    std::uint32_t children = 0, last = 0;
    for (std::uint32_t child = 0; child < child_count; ++child) {
        entries += counts[child];
        if (counts[child] == 0) continue;
        children |= 1u << child;
        last = child;
    }
    if (!is_worthwhile(task, counts, entries)) return false;

    const std::uint32_t first_node = this->tree_.split(task.node, static_cast<std::uint16_t>(children));
    if (records_.size() < task.end + entries) records_.resize(std::max(task.end + entries, 2 * records_.size()));
    Counts target{};
    std::uint32_t top = task.end, node = first_node + static_cast<std::uint32_t>(std::popcount(children));
    for (std::uint32_t child = last + 1; child-- > 0;) {  // the first child is on top of the stack, so it comes next
        if (counts[child] == 0) continue;
        target[child] = top;
        const std::uint64_t spare = (task.spare - (entries - count)) * std::uint64_t{counts[child]} / entries;
        tasks_.push_back({task.path.child(child), --node, top, top + counts[child], static_cast<std::uint32_t>(spare)});
        top += counts[child];
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        const Record record = records_[task.begin + i];
        for (std::uint32_t mask = masks_[i]; mask != 0; mask &= mask - 1)
            records_[target[static_cast<std::size_t>(std::countr_zero(mask))]++] = record;
    }
    return true;
}

/// Sorts the references of the leaf by their marks.
template <int Dim> void BucketTree<Dim>::make_leaf(const Task& task) {
    CellTree& tree = this->tree_;
    const std::span<const Move> rows = this->store_.regular();
    tree.add_leaf(task.node);
    Steps first{};
    for (std::size_t a = 0; a < Dim; ++a) first[a] = static_cast<std::uint16_t>(task.path.begin(a));
    const std::uint64_t begin = packed(first);
    const auto mark_of_record = [begin](const Record& record) {
        const std::uint64_t begins = no_less(record.lo, begin);
        return static_cast<std::uint32_t>(begins | begins >> 15 | begins >> 30) & owned;
    };
    Counts mark_counts{};
    for (std::uint32_t i = task.begin; i < task.end; ++i) {
        const Record& record = records_[i];
        const std::uint32_t mark = mark_of_record(record), row = record.row();
        ++mark_counts[mark];
        if (mark == owned) place_[row] = tree.add_owned(rows[row]);
    }
    const std::uint32_t references = task.end - task.begin - mark_counts[owned];
    if (references == 0) return;
    const std::span<CellTree::Reference> row = tree.add_references(references);
    Counts target{};
    for (std::uint32_t mark = 1; mark < child_count; ++mark) target[mark] = target[mark - 1] + mark_counts[mark - 1];
    for (std::uint32_t i = task.begin; i < task.end; ++i) {
        const std::uint32_t mark = mark_of_record(records_[i]);
        // The leaf that owns the box was made before, as leaves are made in traversal order.
        if (mark != owned) row[target[mark]++] = {place_[records_[i].row()], mark};
    }
}

template <int Dim> void BucketTree<Dim>::find_pairs(std::vector<Pair>& out) const {
    PairSink sink(out);
    this->store_.unbounded_pairs(false, [&](Proxy p, Proxy q) { sink.add(p, q); });
    find_pairs_in_leaves(this->tree_, {0, this->tree_.leaves().size()}, Dim, false, sink);
}

template <int Dim> void BucketTree<Dim>::find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const {
    {
        PairSink sink(out);
        this->store_.unbounded_pairs(false, [&](Proxy p, Proxy q) { sink.add(p, q); });
    }
    const std::size_t leaves = this->tree_.leaves().size();
    find_in_parts(tasks, parts_of(leaves), buffers_, out, [&](std::size_t i, std::vector<Pair>& found) {
        PairSink sink(found);
        find_pairs_in_leaves(this->tree_, leaves_of_part(leaves, i), Dim, false, sink);
    });
}

template <int Dim> void BucketTree<Dim>::find_awake_pairs(std::vector<Pair>& out) const {
    if (this->store_.resting() == 0) return find_pairs(out);
    PairSink sink(out);
    this->store_.unbounded_pairs(true, [&](Proxy p, Proxy q) { sink.add(p, q); });
    const std::span<const CellTree::Node> nodes = this->tree_.nodes();
    if (nodes.empty()) return;
    constexpr std::size_t gap = 64;  // sleeping leaves within a range are cheaper to skip one by one
    LeafRange range;
    LocalStack<std::uint32_t, 128> open;
    open.push(CellTree::root);
    while (!open.empty()) {
        const CellTree::Node& node = nodes[open.pop()];
        if (!node.awake) continue;
        if (node.is_leaf()) {
            if (node.leaf_begin > range.end + gap) {
                find_pairs_in_leaves(this->tree_, range, Dim, true, sink);
                range.begin = node.leaf_begin;
            }
            range.end = node.leaf_end;
        }
        for (int k = std::popcount(node.children); k-- > 0;)
            open.push(node.first_child + static_cast<std::uint32_t>(k));
    }
    find_pairs_in_leaves(this->tree_, range, Dim, true, sink);
}

/// Checks the leaves against the steps of all boxes, computed again.
template <int Dim> std::string BucketTree<Dim>::broken_cells() const {
    const CellTree& tree = this->tree_;
    std::string broken;
    std::vector<std::uint32_t> entries_of(tree.boxes().size(), 0);
    tree.walk(Path{}, [&](std::uint32_t at, const Path& path) {
        const CellTree::Node& node = tree.nodes()[at];
        if (path.depth > limits_.max_depth) broken = "a node is too deep";
        if (!node.is_leaf()) return;
        const CellTree::Leaf& leaf = tree.leaves()[node.leaf_begin];
        const auto check = [&](std::uint32_t place, std::uint32_t mark) {
            const Steps lo = this->frame_.steps_of(tree.boxes()[place].lo),
                        hi = this->frame_.steps_of(tree.boxes()[place].hi);
            ++entries_of[place];
            for (std::size_t a = 0; a < Dim; ++a)
                if (lo[a] >= path.end(a) || hi[a] < path.begin(a))
                    broken = "a leaf holds a box that does not overlap it";
            if (mark_of(lo, path) != mark) broken = "the mark of a box does not match where it begins";
        };
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.owned; ++i) check(i, owned);
        std::uint32_t before = 0;
        for (const CellTree::Reference reference : tree.references().subspan(leaf.first_reference, leaf.references)) {
            check(reference.place(), reference.mark());
            if (reference.mark() < before) broken = "the references of a leaf are not sorted by their mark";
            before = reference.mark();
        }
    });
    std::vector<std::uint32_t> leaves_of(tree.boxes().size(), 0);
    struct Branch {
        std::uint32_t node, place;
        Path path;
    };
    LocalStack<Branch, 128> open;
    for (std::uint32_t place = 0; place < tree.boxes().size() && broken.empty(); ++place) {
        const Steps lo = this->frame_.steps_of(tree.boxes()[place].lo),
                    hi = this->frame_.steps_of(tree.boxes()[place].hi);
        open.push({CellTree::root, place, Path{}});
        while (!open.empty()) {
            const Branch branch = open.pop();
            const CellTree::Node& node = tree.nodes()[branch.node];
            bool overlapping = true;
            for (std::size_t a = 0; a < Dim; ++a)
                overlapping = overlapping && lo[a] < branch.path.end(a) && hi[a] >= branch.path.begin(a);
            if (!overlapping) continue;
            if (node.is_leaf()) ++leaves_of[place];
            std::uint32_t child = node.first_child;
            for (std::uint32_t k = 0; k < child_count; ++k)
                if ((node.children >> k & 1) != 0) open.push({child++, place, branch.path.child(k)});
        }
    }
    if (broken.empty() && leaves_of != entries_of) return "a box is not in every leaf that it overlaps";
    const std::size_t entries = tree.boxes().size() + tree.references().size();
    if (broken.empty() && entries > max_entries * tree.boxes().size()) return "there are too many entries";
    return broken;
}

template class BucketTree<2>;
template class BucketTree<3>;

}  // namespace fase::broad
