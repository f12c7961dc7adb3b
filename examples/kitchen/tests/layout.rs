//! The files of kitchens: what they say, and what is told of their mistakes.

use tltl_kitchen::Layout;

/// The compatibility table of AI2-THOR 0.0.25: objects by row; columns cabinet, coffee machine,
/// counter top, fridge, garbage can, microwave, pan and pot, sink, table top.
const FITS: [(&str, &str); 16] = [
    ("apple", "..XXX.XXX"),
    ("bowl", "X.XX.X.XX"),
    ("bread", "X.XXXX..X"),
    ("butter_knife", "X.X....XX"),
    ("container", "X.XX.X.XX"),
    ("cup", "X.XX.X.XX"),
    ("egg", "..XXXX.XX"),
    ("fork", "X.X....XX"),
    ("knife", "X.X....XX"),
    ("lettuce", "..XX..XXX"),
    ("mug", "XXXX.X.XX"),
    ("plate", "X.XX.X.XX"),
    ("potato", "X.XXXXXXX"),
    ("soap_bottle", "X.X.X..XX"),
    ("spoon", "X.X....XX"),
    ("tomato", "..XXX.XXX"),
];

const COLUMNS: [&str; 9] = [
    "cabinet",
    "coffee_machine",
    "counter_top",
    "fridge",
    "garbage_can",
    "microwave",
    "pan",
    "sink",
    "table_top",
];

/// Ids, whether there is a door, capacity, the level that is needed.
const RECEPTACLES: [(std::ops::RangeInclusive<u8>, bool, u8, u8); 14] = [
    (17..=25, true, 1, 1),
    (26..=33, true, 1, 3),
    (34..=37, true, 1, 2),
    (38..=40, true, 1, 1),
    (41..=43, false, 4, 1),
    (44..=44, false, 4, 1),
    (45..=45, true, 6, 1),
    (46..=46, true, 1, 2),
    (47..=47, false, 2, 1),
    (48..=48, false, 1, 2),
    (49..=49, false, 2, 2),
    (50..=53, false, 1, 2),
    (54..=54, false, 1, 2),
    (55..=55, false, 1, 2),
];

#[test]
fn floorplan24_is_the_kitchen_of_the_facts() {
    let layout = Layout::floorplan24();
    assert_eq!((layout.objects(), layout.receptacles(), layout.actions()), (17, 39, 62));
    for (ids, door, capacity, level) in RECEPTACLES {
        for r in ids {
            let found = (layout.has_door(r), layout.capacity(r), layout.level(r));
            assert_eq!(found, (door, capacity, level), "{}", layout.name(r));
        }
    }
    for (name, id) in [("apple", 0), ("container_2", 5), ("tomato", 16), ("cabinet_1", 17)] {
        assert_eq!(layout.id(name), Some(id));
    }
    for (name, id) in [("cabinet_21", 37), ("drawer_3", 40), ("fridge", 45), ("pan", 55)] {
        assert_eq!(layout.id(name), Some(id));
    }
    assert_eq!(layout.type_name(38), "cabinet");
}

#[test]
fn what_fits_where_is_the_table() {
    let layout = Layout::floorplan24();
    for o in layout.object_ids() {
        let (_, row) = FITS.iter().find(|(name, _)| *name == layout.type_name(o)).unwrap();
        for r in layout.receptacle_ids() {
            let kind = layout.type_name(r).replace("pot", "pan");
            let column = COLUMNS.iter().position(|&column| column == kind);
            let fits = column.is_some_and(|i| row.as_bytes()[i] == b'X');
            assert_eq!(layout.may_hold(r, o), fits, "{} in {}", layout.name(o), layout.name(r));
            assert_eq!(layout.feasible(o, r), fits);
        }
    }
    assert_eq!(layout.feasible_goals().count(), 432);
}

/// A kitchen that is right, but for what replaces a part of it.
const RIGHT: &str = r#"
[[object]]
type = "mug"
count = 2
fits = ["sink", "shelf"]

[[receptacle]]
type = "sink"
capacity = 1
horizon = 30

[[receptacle]]
type = "shelf"
door = true
capacity = 2
horizon = 0
"#;

/// (what is replaced, by what, what is told).
const MISTAKES: [(&str, &str, &str); 23] = [
    (
        "\"sink\", ",
        "\"snik\", ",
        "line 5, column 9: there is no receptacle of type `snik`; did you mean `sink`?",
    ),
    ("\"sink\", ", "\"wardrobe\", ", "line 5, column 9: there is no receptacle of type `wardrobe`"),
    ("\"sink\", ", "\"shelf\", ", "line 5, column 18: `mug` lists `shelf` twice"),
    (
        "[\"sink\", \"shelf\"]",
        "[]",
        "line 5, column 8: `mug` fits nowhere: list types of receptacles in `fits`",
    ),
    (
        "\"sink\", ",
        "",
        "line 8, column 8: no object fits `sink`: list it in a `fits`, or say `receives = false`",
    ),
    (
        "capacity = 1",
        "capacity = 1\nreceives = false",
        "line 5, column 9: `sink` is said to receive nothing (`receives = false`)",
    ),
    (
        "capacity = 1",
        "capacity = 0",
        "line 9, column 12: `capacity` of `sink` is 0; 1 to 64 are possible",
    ),
    (
        "capacity = 1",
        "capacity = 65",
        "line 9, column 12: `capacity` of `sink` is 65; 1 to 64 are possible",
    ),
    (
        "horizon = 30",
        "horizon = 45",
        "line 10, column 11: the horizon 45 is not one of 60, 30, 0 and -30 degrees",
    ),
    ("count = 2", "count = 0", "line 4, column 9: `count` of `mug` is 0; 1 to 64 are possible"),
    ("count = 2", "count = 63", "with `shelf` there are more than 64 objects and receptacles"),
    (
        "count = 2",
        "count = 4",
        "there is not enough room: of 4 objects only 3 can be put somewhere at once",
    ),
    (
        "count = 2",
        "first = 9223372036854775807\ncount = 2",
        "line 4, column 9: `first` of `mug` is 9223372036854775807; 0 to 9999 are possible",
    ),
    ("count = 2", "cuont = 2", "line 4, column 1: unknown field `cuont`"),
    ("count = 2", "count = \"2\"", "line 4, column 9: invalid type: string \"2\", expected i64"),
    ("count = 2", "count 2", "line 4, column 7:"),
    ("\"mug\"", "\"sink\"", "line 8, column 8: there are two called `sink_1`: "),
    (
        "type = \"shelf\"",
        "type = \"shelf\"\nname = \"sink\"",
        "line 14, column 8: there are two called `sink`: give it a `name`",
    ),
    (
        "type = \"mug\"",
        "type = \"Mug\"",
        "line 3, column 8: `Mug` is no name: write lower-case letters, digits and `_`, a letter first",
    ),
    ("capacity = 1\n", "", "missing field `capacity`"),
    (
        "[[object]]",
        "[[thing]]",
        "line 2, column 3: unknown field `thing`, expected `object` or `receptacle`",
    ),
    ("type = \"mug\"\n", "", "missing field `type`"),
    ("door = true", "door = 1", "line 14, column 8: invalid type: integer `1`, expected a boolean"),
];

#[test]
fn mistakes_are_told_with_their_place() {
    Layout::parse(RIGHT).unwrap();
    for (right, wrong, told) in MISTAKES {
        assert!(RIGHT.contains(right), "{right}");
        let mut text = RIGHT.replacen(right, wrong, 1);
        if wrong == "\"sink\"" {
            text = text.replacen("capacity = 1", "count = 2\ncapacity = 1", 1);
        }
        let error = Layout::parse(&text).expect_err(told).to_string();
        assert!(error.contains(told), "told: {error}\nexpected: {told}");
    }
}

#[test]
fn a_kitchen_needs_objects_and_receptacles() {
    let error = |text: &str| Layout::parse(text).unwrap_err().to_string();
    assert!(error("").starts_with("the kitchen has no object"));
    let only_objects = "[[object]]\ntype = \"mug\"\nfits = [\"sink\"]";
    assert!(error(only_objects).starts_with("the kitchen has no receptacle"));
    let missing = Layout::load("no/such/kitchen.toml").unwrap_err().to_string();
    assert!(missing.starts_with("no/such/kitchen.toml: cannot be read: "), "{missing}");
}

#[test]
fn an_object_that_has_but_one_place_cannot_be_wanted_there() {
    let text = RIGHT.replace(
        "count = 2\nfits = [\"sink\", \"shelf\"]",
        "fits = [\"sink\"]\n\n[[object]]\ntype = \"cup\"\nfits = [\"shelf\", \"sink\"]",
    );
    let layout = Layout::parse(&text).unwrap();
    let names = |goal: tltl_kitchen::Goal| [layout.name(goal.object), layout.name(goal.receptacle)];
    let goals: Vec<_> = layout.feasible_goals().map(names).collect();
    // The mug needs the sink, so the cup is never there, and the mug always.
    assert_eq!(goals, [["cup", "sink"]]);
}
