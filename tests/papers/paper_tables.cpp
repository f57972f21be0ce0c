// Prints the papers' claims beside what this code does, as Markdown.
#include "paper_tables.h"

#include <fmt/ostream.h>

#include <algorithm>
#include <iostream>
#include <vector>

#include "balloon.h"
#include "dcn.h"
#include "finger.h"
#include "flops.h"
#include "kavan.h"
#include "kavan_properties.h"
#include "kavan_speed.h"

namespace {

using probewarp::papers::Table;

/// In the order in which they are printed. A new table is one row of its file's list, a new file one row
/// here.
std::vector<Table> all_tables() {
    namespace papers = probewarp::papers;
    std::vector<Table> tables;
    for (const auto rows : {papers::flops_tables(), papers::dcn_tables(), papers::kavan_tables(),
                            papers::kavan_properties_tables(), papers::kavan_speed_tables(),
                            papers::finger_tables(), papers::balloon_tables()})
        tables.insert(tables.end(), rows.begin(), rows.end());
    return tables;
}

void print(const Table& table) {
    fmt::print(std::cout, "## {}\n\n", table.title);
    table.print(std::cout);
    std::cout << '\n';
}

}  // namespace

int main(int argc, char** argv) {
    const auto tables = all_tables();
    const std::string_view wanted = argc > 1 ? argv[1] : "";
    if (argc > 2 || wanted == "--help") {
        std::cerr << "usage: paper_tables [--list | NAME]\n";
        return wanted == "--help" ? 0 : 2;
    }
    if (wanted == "--list") {
        for (const auto& t : tables) fmt::print(std::cout, "{:20} {}\n", t.name, t.title);
        return 0;
    }
    if (wanted.empty()) {
        for (const auto& t : tables) print(t);
        return 0;
    }
    const auto found = std::ranges::find(tables, wanted, &Table::name);
    if (found == tables.end()) {
        fmt::print(std::cerr, "paper_tables: there is no table {}; --list names them.\n", wanted);
        return 2;
    }
    print(*found);
}
