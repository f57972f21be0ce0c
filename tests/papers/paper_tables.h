// What a table of a paper's claims is to the program paper_tables. One .h/.cpp pair a paper or table:
// functions that return values, which the tests hold, and apart from them the functions that print.
#pragma once

#include <ostream>
#include <span>
#include <string_view>

namespace probewarp::papers {

struct Table {
    std::string_view name;         ///< as the command line has it
    std::string_view title;        ///< the paper and the place in it
    void (*print)(std::ostream&);  ///< Markdown: what was measured in a sentence, then the table
};

}  // namespace probewarp::papers
