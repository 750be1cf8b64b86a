// Model files that are text: words and numbers, and the line they stand on.
#ifndef MESH_TEXT_H
#define MESH_TEXT_H

#include "base/base.h"

typedef struct text {
    const char *at, *end;
    int64_t line; // counted from 1
} text;

/// Over white space, line ends too.
void skip_space(text *in);

/// Over white space within the line, and over a line end behind a backslash.
void skip_blanks(text *in);

/// To the end of the line.
void skip_line(text *in);

/// To the first word of a line that is not empty; a # begins a comment. False at the end of the text.
bool next_line(text *in);

/// The next word on this or a later line, in lower case, cut to the room there is. False at the end of the
/// text.
bool take_word(text *in, char *word, size_t room);

/// A finite number on this line. False, and nothing taken, when there is none.
bool take_number(text *in, double *value);

/// A whole number on this line, its sign perhaps; held within 64 bits.
bool take_whole(text *in, int64_t *value);

/// Three numbers on this line, as float32 holds them.
bool take_point(text *in, double point[3]);

#endif
