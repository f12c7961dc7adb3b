static inline double $_min(double a, double b) { return a < b || a != a ? a : b; }

static inline double $_max(double a, double b) { return a > b || a != a ? a : b; }

static inline double $_less(double a, double b) { return a < b ? a : b; }

static inline double $_greater(double a, double b) { return a > b ? a : b; }

static inline int $_positive(double rho, int *nan) { *nan |= rho != rho; return rho > 0; }

static inline int $_not_negative(double rho, int *nan) { *nan |= rho != rho; return rho >= 0; }

static inline int $_zero(double rho, int *nan) { *nan |= rho != rho; return rho == 0; }

/* An index, or 0 and a note if there is no such element. */
static inline unsigned $_index(uint64_t i, unsigned length, int *nan)
{
    if (i < length) return (unsigned)i;
    *nan = 1;
    return 0;
}

static inline void $_fill(double *cells, unsigned length)
{
    unsigned i;
    for (i = 0; i < length; i++) cells[i] = -INFINITY;
}

/* The number of `length` steps ago. */
static inline double $_delay(double *cells, unsigned length, uint16_t *place, double now)
{
    const double then = cells[*place];
    cells[*place] = now;
    *place = (uint16_t)(*place + 1u < length ? *place + 1u : 0u);
    return then;
}

/* The greatest of the last `length` numbers; there is one cell more. */
static inline double $_slide_max(double *cells, unsigned length, uint16_t *place, double now)
{
    const unsigned at = *place;
    unsigned i;
    cells[length] = at == 0 ? now : $_greater(cells[length], now);
    cells[at] = now;
    *place = (uint16_t)(at + 1 < length ? at + 1 : 0);
    if (at + 1 < length) return $_greater(cells[length], cells[at + 1]);
    for (i = length - 1; i > 0; i--) cells[i - 1] = $_greater(cells[i - 1], cells[i]);
    return cells[length];
}

/* The least of the last `length` numbers; there is one cell more. */
static inline double $_slide_min(double *cells, unsigned length, uint16_t *place, double now)
{
    const unsigned at = *place;
    unsigned i;
    cells[length] = at == 0 ? now : $_less(cells[length], now);
    cells[at] = now;
    *place = (uint16_t)(at + 1 < length ? at + 1 : 0);
    if (at + 1 < length) return $_less(cells[length], cells[at + 1]);
    for (i = length - 1; i > 0; i--) cells[i - 1] = $_less(cells[i - 1], cells[i]);
    return cells[length];
}

/* Entry i of a ring: weights of starts, which fall from the oldest to the newest. */
static inline unsigned $_cell(unsigned first, unsigned i, unsigned cells)
{
    return first + i < cells ? first + i : first + i - cells;
}

static inline void $_push(double *weight, uint16_t *at, unsigned cells, const uint16_t *first,
    uint16_t *length, double now, uint16_t t)
{
    while (*length > 0 && weight[$_cell(*first, *length - 1u, cells)] <= now) --*length;
    if (now > -INFINITY) {
        const unsigned cell = $_cell(*first, *length, cells);
        weight[cell] = now;
        at[cell] = t;
        ++*length;
    }
}

/* Forgets starts of n steps ago. */
static inline void $_forget(const double *weight, const uint16_t *at, unsigned cells, uint16_t *first,
    uint16_t *length, unsigned n, uint16_t t)
{
    (void)weight;
    while (*length > 0 && (uint16_t)(t - at[*first]) >= n) {
        *first = (uint16_t)$_cell(*first, 1, cells);
        --*length;
    }
}

/* What a condition of robustness `rho` leaves of all weights. */
static inline void $_lower(double *weight, uint16_t *at, unsigned cells, uint16_t *first,
    uint16_t *length, double rho)
{
    bool any = false;
    uint16_t newest = 0;
    while (*length > 0 && weight[*first] > rho) {
        any = true;
        newest = at[*first];
        *first = (uint16_t)$_cell(*first, 1, cells);
        --*length;
    }
    if (any) {
        *first = (uint16_t)(*first > 0 ? *first - 1u : cells - 1u);
        weight[*first] = rho;
        at[*first] = newest;
        ++*length;
    }
}
