#pragma once
/// The command `fase distance`: signed distances of pairs of shapes from a file, held against published ones.
#include <string>

namespace CLI {
class App;
}

namespace fase::cli {

class Start;

struct DistanceOptions {
    std::string file;   ///< pairs.json: see run_distance()
    bool json = false;  ///< one JSON value on stdout instead of lines
};

/// Prints the signed distance of every case of the file, its error against the published number, and "N of M within
/// tolerance". The file: {"cases": [{id, a, b, distance, tol, sign, distance_computed_by_us}]}; a and b: {type, size,
/// pos, rot}: box (half sizes), sphere (radius), capsule and cylinder (radius, half length along local z); rot by rows,
/// local to world. A case is judged by `distance` ± `tol`, by the sign of `sign`, and by `distance_computed_by_us`, as
/// far as it has them; with none of them, or with a shape that Fase lacks, it is skipped and the reason printed.
/// Returns the exit code: 0; 1 a case is wrong; 2 the file is not as above; 3 it cannot be read.
int run_distance(const DistanceOptions& options);

/// Adds the command to the program.
void add_distance(CLI::App& app, Start& start);

}  // namespace fase::cli
