#pragma once
/// The list of all structures. To add one, include its header and add one line here.
#include "fase/broad/brute_force.hpp"
#include "fase/broad/bsp.hpp"
#include "fase/broad/dynamic_bvh.hpp"
#include "fase/broad/incremental_sweep.hpp"
#include "fase/broad/kd_tree.hpp"
#include "fase/broad/loose_octree.hpp"
#include "fase/broad/octree.hpp"
#include "fase/broad/quadtree.hpp"
#include "fase/broad/row_grid.hpp"
#include "fase/broad/sweep_and_prune.hpp"
#include "fase/broad/uniform_grid.hpp"
#include "fase/broad/wide_bvh.hpp"

namespace fase::broad {

template <Structure... S> struct StructureList {};

/// Brute force comes first: it is the reference (oracle) of the tests.
using AllStructures = StructureList<  //
    BruteForce,                       //
    SweepAndPrune,                    //
    IncrementalSweep,                 //
    UniformGrid,                      //
    RowGrid,                          //
    Quadtree,                         //
    Octree,                           //
    LooseOctree,                      //
    KdTree,                           //
    Bsp,                              //
    DynamicBvh,                       //
    WideBvh>;

/// Calls f.operator()<S>() for every structure, in the order of the list.
template <class F, class... S> void for_each_structure(F&& f, StructureList<S...>) {
    (f.template operator()<S>(), ...);
}
template <class F> void for_each_structure(F&& f) { for_each_structure(f, AllStructures{}); }

/// The structure used when the user names none, or "auto".
inline constexpr std::string_view default_structure = RowGrid::info.name;

}  // namespace fase::broad
