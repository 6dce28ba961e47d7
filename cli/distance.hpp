#pragma once
/// The command `fase distance`: compares signed distances of pairs of shapes with published values.
#include <string>

namespace fase::cli {

class Command;
class CommandRegistry;

struct DistanceOptions {
    std::string file;   ///< pairs.json: see run_distance()
    bool json = false;  ///< one JSON value on stdout instead of lines
};

/// Prints the signed distance of every case in the file, its error relative to the published number, and "N of M within
/// tolerance". The file: {"cases": [{id, a, b, distance, tol, sign, distance_computed_by_us}]}; a and b: {type, size,
/// pos, rot}: box (half sizes), sphere (radius), capsule and cylinder (radius, half length along local z); rot by rows,
/// local to world. A case is checked against those of `distance` ± `tol`, the sign of `sign`, and
/// `distance_computed_by_us` that it has. A case with none of them, or with a shape that Fase lacks, is skipped and the
/// reason is printed. Returns the exit code: 0; 1 a case is wrong; 2 the file has another format; 3 it cannot be read.
int run_distance(const DistanceOptions& options);

/// Adds the command to the program.
void add_distance(Command& program, CommandRegistry& registry);

}  // namespace fase::cli
