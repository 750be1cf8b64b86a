// Text inside XML.
#ifndef WRITE_XML_H
#define WRITE_XML_H

#include "base/bytes.h"

/// Append UTF-8 text, escaped; what XML cannot hold (control characters, broken UTF-8) becomes '?'.
jali_status xml_text(jali_context *ctx, const char *text, jali_bytes *bytes);

#endif
