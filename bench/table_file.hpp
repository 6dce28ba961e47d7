#pragma once
/// Tables of measured figures, as CSV files that only grow, with where and when the figures come from.
#include <string>
#include <vector>

#include "fase/core/result.hpp"

namespace fase::bench {

/// Where figures come from.
struct Origin {
    std::string date;  ///< YYYY-MM-DD, UTC
    std::string
        commit;  ///< of the repository that the program is started in, with "-dirty" when it was changed; or "unknown"
    std::string machine;  ///< the processor's name and how many the system shows
};
[[nodiscard]] Origin origin_of_figures();

/// Adds rows to a CSV file (RFC 4180, line ends of one byte); a new one gets `columns` as its first line. Format when
/// the file has other columns, Io when it cannot be read or written; then it is as it was.
Result<void> append_to_table(const std::string& file, const std::vector<std::string>& columns,
                             const std::vector<std::vector<std::string>>& rows);

}  // namespace fase::bench
