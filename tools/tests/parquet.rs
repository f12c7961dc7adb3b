//! Recordings in Parquet: the same rows as CSV give the same output, and what has no reading is
//! refused in a sentence.

use std::fmt::Write as _;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::Arc;

use parquet::basic::Compression;
use parquet::data_type::{
    BoolType, ByteArrayType, DataType, DoubleType, FloatType, Int32Type, Int64Type,
};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;

const SCHEMA: &str = "message schema {
    required int64 run;
    optional double x;
    optional group pose { required float y; }
    required boolean holding;
    optional binary place (STRING);
    required int32 battery (INTEGER(8, false));
    required group joints (LIST) { repeated group list { required double element; } }
    required int64 time (TIMESTAMP(MILLIS, true));
}";

const TASKS: &str = "enum Place { home, shelf }
    struct Pose { y: f32 }
    state Robot { x: f64, pose: Pose, holding: bool, place: Place?, battery: u8 }
    task fetch = (place == shelf && holding && battery < 250) T (x < pose.y || place == none)";

const ROWS: usize = 10_000;

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

fn run(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_tltlc"));
    command.current_dir(env!("CARGO_TARGET_TMPDIR")).args(arguments).output().unwrap()
}

/// One row: what its columns hold.
struct Row {
    run: i64,
    x: f64,
    y: f32,
    holding: bool,
    place: Option<&'static str>,
    battery: u8,
}

fn rows() -> Vec<Row> {
    let mut seed = 7_u32;
    let mut random = move |below: u32| {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) % below
    };
    let mut row = |at: usize| Row {
        run: (at / 100) as i64,
        x: f64::from(random(1_000_000)) / 7.0,
        y: random(1_000) as f32 / 3.0,
        holding: random(4) == 0,
        place: [None, Some("home"), Some("shelf")][random(3) as usize],
        battery: random(256) as u8,
    };
    (0..ROWS).map(&mut row).collect()
}

/// Writes the next column: its values, and whether each row has one.
fn column<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, File>,
    values: &[T::T],
    levels: Option<&[i16]>,
    lists: Option<&[i16]>,
) {
    let mut column = group.next_column().unwrap().unwrap();
    column.typed::<T>().write_batch(values, levels, lists).unwrap();
    column.close().unwrap();
}

/// Writes the rows in groups of three sizes.
fn write(name: &str, rows: &[Row], compression: Compression) {
    let schema = Arc::new(parse_message_type(SCHEMA).unwrap());
    let properties = WriterProperties::builder().set_compression(compression).build();
    let file = File::create(path(name)).unwrap();
    let mut writer = SerializedFileWriter::new(file, schema, Arc::new(properties)).unwrap();
    for rows in [&rows[..1], &rows[1..5_000], &rows[5_000..]] {
        let full = vec![1_i16; rows.len()];
        let mut group = writer.next_row_group().unwrap();
        let of = |row: &dyn Fn(&Row) -> f64| rows.iter().map(row).collect::<Vec<_>>();
        let runs: Vec<i64> = rows.iter().map(|row| row.run).collect();
        column::<Int64Type>(&mut group, &runs, None, None);
        column::<DoubleType>(&mut group, &of(&|row| row.x), Some(&full), None);
        let y: Vec<f32> = rows.iter().map(|row| row.y).collect();
        column::<FloatType>(&mut group, &y, Some(&full), None);
        let holding: Vec<bool> = rows.iter().map(|row| row.holding).collect();
        column::<BoolType>(&mut group, &holding, None, None);
        let places: Vec<_> = rows.iter().filter_map(|row| Some(row.place?.into())).collect();
        let levels: Vec<i16> = rows.iter().map(|row| row.place.is_some().into()).collect();
        column::<ByteArrayType>(&mut group, &places, Some(&levels), None);
        let battery: Vec<i32> = rows.iter().map(|row| row.battery.into()).collect();
        column::<Int32Type>(&mut group, &battery, None, None);
        column::<DoubleType>(
            &mut group,
            &of(&|row| row.x),
            Some(&full),
            Some(&vec![0; rows.len()]),
        );
        column::<Int64Type>(&mut group, &runs, None, None);
        group.close().unwrap();
    }
    writer.close().unwrap();
}

#[test]
fn parquet_is_read_as_the_same_rows_of_csv_are() {
    let rows = rows();
    let mut csv = String::from("run,holding,pose.y,x,place,battery\n");
    for Row { run, x, y, holding, place, battery } in &rows {
        let place = place.unwrap_or_default();
        writeln!(csv, "{run},{holding},{y},{x},{place},{battery}").unwrap();
    }
    std::fs::write(path("rows.csv"), csv).unwrap();
    std::fs::write(path("fetch.tltl"), TASKS).unwrap();
    let shown = |file: &str| {
        let Output { stdout, stderr, .. } =
            run(&["run", "fetch.tltl", file, "--episode", "run", "--format", "csv"]);
        assert_eq!(String::from_utf8(stderr).unwrap(), "");
        String::from_utf8(stdout).unwrap().replace(".parquet", ".csv")
    };
    let expected = shown("rows.csv");
    assert!(expected.lines().count() > ROWS && expected.contains("satisfied"));
    let zstd = Compression::ZSTD(Default::default());
    for compression in [Compression::UNCOMPRESSED, Compression::SNAPPY, zstd] {
        write("rows.parquet", &rows, compression);
        assert!(shown("rows.parquet") == expected, "{compression:?}");
    }
}

#[test]
fn what_has_no_reading_is_refused() {
    write("all.parquet", &rows(), Compression::SNAPPY);
    let whole = std::fs::read(path("all.parquet")).unwrap();
    for (name, bytes) in [("cut", &whole[..whole.len() / 2]), ("start", &whole[..5])] {
        std::fs::write(path(&format!("{name}.parquet")), bytes).unwrap();
    }
    for (formula, file, shown) in [
        ("F (joints[1] > 2)", "all.parquet", "`joints` holds a list in each row"),
        ("F (joints > 2)", "all.parquet", "`joints` holds a list in each row"),
        ("F (time > 2)", "all.parquet", "the column `time` holds times"),
        ("F (place > 2)", "all.parquet", "all.parquet: row 0: `"),
        (
            "F (tick > 2)",
            "all.parquet",
            "the task reads the column `tick`; the file has `run`, `x`",
        ),
        ("F (x > 2)", "cut.parquet", "cut.parquet: this is not Parquet, or not all of it"),
        ("F (x > 2)", "start.parquet", "start.parquet: this is not Parquet, or not all of it"),
    ] {
        let Output { status, stderr, .. } = run(&["run", formula, file]);
        let text = String::from_utf8(stderr).unwrap();
        assert!(text.contains(shown) && text.len() < 400, "{formula}: {text}");
        assert_eq!(status.code(), Some(2), "{formula}");
    }
}
