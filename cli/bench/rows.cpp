/// What the commands of `fase bench` have in common.
#include "cli/bench/rows.hpp"

#include <cstdio>

#include "bench/table_file.hpp"
#include "cli/common/interrupt.hpp"
#include "cli/common/output.hpp"

namespace fase::cli {

Result<void> check_csv(const std::string& file) {
    if (file.empty()) return {};
    return check_output(file, {output::table});
}

Result<void> append_rows(const std::string& file, std::vector<std::string> columns,
                         std::vector<std::vector<std::string>> rows) {
    if (file.empty() || rows.empty()) return {};
    const bench::Origin origin = bench::origin_of_figures();
    columns.insert(columns.begin(), {"date", "commit", "machine"});
    for (std::vector<std::string>& row : rows) row.insert(row.begin(), {origin.date, origin.commit, origin.machine});
    if (auto made = make_folder_of(file); !made) return made;
    return bench::append_to_table(file, columns, rows);
}

int print_rows(const std::string& text, bool all_right) {
    std::fwrite(text.data(), 1, text.size(), stdout);
    if (Interrupts::signal() != 0) return 128 + Interrupts::signal();
    return all_right ? exit_ok : exit_check_failed;
}

}  // namespace fase::cli
