// A client for jali serve: plain sockets, so that requests may be as wrong as we like.
#ifndef TESTS_HTTP_H
#define TESTS_HTTP_H

#include <arpa/inet.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

/// A server that a test has started.
typedef struct served {
    pid_t pid;
    int port;
    char token[64];
    FILE *out;
} served;

/// An answer; free its text.
typedef struct reply {
    int status; // 0 = there was none
    char *text; // head and body, with an end mark
    char *body; // in it
    size_t size;
} reply;

static inline void reply_free(reply *r)
{
    free(r->text);
    *r = (reply){0};
}

/// Start it; what it needs besides the port follows.
static inline served serve(const char *program, const char *arguments)
{
    char command[1024], line[512] = "";
    served s = {0};
    int out[2];
    if (pipe(out) != 0) return s;
    snprintf(command, sizeof command, "exec %s serve --port 0 --quiet %s", program, arguments);
    s.pid = fork();
    if (s.pid < 0) return s;
    if (s.pid == 0) {
        prctl(PR_SET_PDEATHSIG, SIGTERM); // it does not outlive a test that is ended
        dup2(out[1], STDOUT_FILENO);
        close(out[0]);
        close(out[1]);
        execl("/bin/sh", "sh", "-c", command, (char *)NULL);
        _exit(127);
    }
    close(out[1]);
    s.out = fdopen(out[0], "r");
    if (s.out && fgets(line, sizeof line, s.out))
        sscanf(line, "http://127.0.0.1:%d/#token=%32[0-9a-f]", &s.port, s.token);
    return s;
}

/// End it by a signal; how it ended.
static inline int stop_serving(served *s, int number)
{
    int state = 0;
    if (s->pid <= 0) return -1; // it never began
    kill(s->pid, number);
    waitpid(s->pid, &state, 0);
    fclose(s->out);
    return WIFEXITED(state) ? WEXITSTATUS(state) : 1000 + WTERMSIG(state);
}

static inline int connect_to(const served *s)
{
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons((uint16_t)s->port)};
    struct timeval patience = {.tv_sec = 120};
    int opened = socket(AF_INET, SOCK_STREAM, 0);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    setsockopt(opened, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    if (connect(opened, (struct sockaddr *)&address, sizeof address) == 0) return opened;
    close(opened);
    return -1;
}

static inline bool send_all(int opened, const void *data, size_t size)
{
    for (const char *at = data; size > 0;) {
        ssize_t sent = send(opened, at, size, MSG_NOSIGNAL);
        if (sent <= 0) return false;
        at += sent;
        size -= (size_t)sent;
    }
    return true;
}

// "5\r\nhello\r\n0\r\n\r\n" is hello.
static inline void unchunk(reply *r)
{
    char *from = r->body, *to = r->body, *end = r->body + r->size;
    while (from < end) {
        size_t piece = strtoul(from, &from, 16);
        from += 2;
        if (piece == 0 || piece > (size_t)(end - from)) break;
        memmove(to, from, piece);
        to += piece;
        from += piece + 2;
    }
    r->size = (size_t)(to - r->body);
    *to = 0;
}

/// Read an answer to its end.
static inline reply read_reply(int opened)
{
    reply r = {0};
    size_t size = 0, capacity = 0;
    for (;;) {
        if (capacity - size < 65536) r.text = realloc(r.text, (capacity = 2 * capacity + 65537));
        ssize_t got = recv(opened, r.text + size, capacity - size - 1, 0);
        if (got <= 0) break;
        size += (size_t)got;
    }
    r.text[size] = 0;
    sscanf(r.text, "HTTP/1.1 %d", &r.status);
    char *blank = memmem(r.text, size, "\r\n\r\n", 4);
    r.body = blank ? blank + 4 : r.text + size;
    r.size = size - (size_t)(r.body - r.text);
    if (blank) *blank = 0;
    if (blank && strstr(r.text, "chunked")) unchunk(&r);
    return r;
}

/// Send bytes as they are.
static inline reply ask_raw(const served *s, const char *head, const void *body, size_t size)
{
    reply r = {0};
    int opened = connect_to(s);
    if (opened < 0) return r;
    if (send_all(opened, head, strlen(head))) send_all(opened, body, size);
    r = read_reply(opened);
    close(opened);
    return r;
}

/// Ask as the page does.
static inline reply ask_bytes(const served *s, const char *method, const char *path, const void *body,
                              size_t size)
{
    char head[1024], length[64] = "";
    if (body) snprintf(length, sizeof length, "Content-Length: %zu\r\n", size);
    snprintf(head, sizeof head,
             "%s %s HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nConnection: close\r\nX-Jali-Token: %s\r\n%s\r\n",
             method, path, s->port, s->token, length);
    return ask_raw(s, head, body, body ? size : 0);
}

static inline reply ask(const served *s, const char *method, const char *path, const char *body)
{
    return ask_bytes(s, method, path, body, body ? strlen(body) : 0);
}

/// The id in an answer.
static inline bool id_of(const reply *r, char id[64])
{
    const char *found = r->text ? strstr(r->body, "\"id\":\"") : NULL;
    *id = 0;
    if (found) sscanf(found + 6, "%32[0-9a-f]", id);
    return *id != 0;
}

#endif
