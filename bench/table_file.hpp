#pragma once
/// Append-only CSV files of measured figures, with the origin of each row.
#include <string>
#include <vector>

#include "fase/core/result.hpp"

namespace fase::bench {

/// The origin of figures.
struct Origin {
    std::string date;  ///< YYYY-MM-DD, UTC
    /// Of the repository in the working directory, with "-dirty" when it has changes; or "unknown".
    std::string commit;
    std::string machine;  ///< name of the processor and number of logical cores
};
[[nodiscard]] Origin origin_of_figures();

/// Appends rows to a CSV file (RFC 4180 with "\n" line ends); a new file gets `columns` as its first line. On error the
/// file is unchanged. Errors: Format: the file has other columns; Io: it cannot be read or written.
Result<void> append_to_table(const std::string& file, const std::vector<std::string>& columns,
                             const std::vector<std::vector<std::string>>& rows);

}  // namespace fase::bench
