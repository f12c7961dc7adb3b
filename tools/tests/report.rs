//! Pages of `tltlc … --format html` in a real browser: headless Chromium, by WebDriver.
//!
//! Where there is no `chromedriver`, nothing is tested and the test says so (Debian has both as the
//! packages `chromium` and `chromium-driver`).

use std::fmt::Write as _;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

/// A browser without a window. It ends with its value.
struct Browser {
    driver: Child,
    port: u16,
    session: String,
}

impl Drop for Browser {
    fn drop(&mut self) {
        if !self.session.is_empty() {
            self.call("DELETE", "", &json!({}));
        }
        let _ = self.driver.kill();
        let _ = self.driver.wait();
    }
}

impl Browser {
    /// `None` where no browser can be driven.
    fn start() -> Option<Self> {
        // The driver takes a free port, and says which.
        let started = Command::new("chromedriver")
            .arg("--port=0")
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn();
        let mut driver = started.ok()?;
        let mut said = String::new();
        let mut stdout = driver.stdout.take()?;
        let until = Instant::now() + Duration::from_secs(60);
        let port = loop {
            let mut piece = [0; 512];
            let read = stdout.read(&mut piece).unwrap();
            said.push_str(&String::from_utf8_lossy(&piece[..read]));
            let port = said.split("on port ").skip(1).find_map(|rest| {
                let end = rest.find(|c: char| !c.is_ascii_digit())?;
                rest[..end].parse().ok().filter(|port| *port > 0)
            });
            if let Some(port) = port {
                break port;
            }
            assert!(read > 0 && Instant::now() < until, "chromedriver does not start: {said}");
        };
        std::thread::spawn(move || std::io::copy(&mut stdout, &mut std::io::sink()));
        let mut browser = Self { driver, port, session: String::new() };
        let arguments =
            ["--headless=new", "--no-sandbox", "--disable-gpu", "--window-size=1200,900"];
        let wanted = json!({"capabilities": {"alwaysMatch": {
            "browserName": "chrome",
            "goog:chromeOptions": {"args": arguments},
            "goog:loggingPrefs": {"browser": "ALL"},
        }}});
        let session = browser.call("POST", "", &wanted)["sessionId"].as_str().unwrap().to_owned();
        browser.session = format!("/{session}");
        Some(browser)
    }

    /// One request of WebDriver, and what it gives.
    fn call(&self, method: &str, path: &str, body: &Value) -> Value {
        let body = body.to_string();
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
        let session = &self.session;
        write!(
            stream,
            "{method} /session{session}{path} HTTP/1.1\r\nHost: localhost\r\n\
             Content-Type: application/json\r\nContent-Length: {}\r\n\r\n{body}",
            body.len()
        )
        .unwrap();
        // The driver keeps the connection open, whatever it is asked.
        let mut stream = BufReader::new(stream);
        let mut head = String::new();
        while !head.ends_with("\r\n\r\n") {
            assert!(stream.read_line(&mut head).unwrap() > 0, "{path}: {head}");
        }
        let lower = head.to_ascii_lowercase();
        let length = lower.lines().find_map(|line| line.strip_prefix("content-length:")).unwrap();
        let mut answer = vec![0; length.trim().parse().unwrap()];
        stream.read_exact(&mut answer).unwrap();
        let answer = String::from_utf8(answer).unwrap();
        assert!(head.starts_with("HTTP/1.1 200"), "{path}: {answer}");
        serde_json::from_str::<Value>(&answer).unwrap()["value"].take()
    }

    fn open(&self, page: &Path) {
        self.call("POST", "/url", &json!({"url": format!("file://{}", page.display())}));
    }

    /// What an expression of the page is.
    fn read(&self, expression: &str) -> Value {
        let script = format!("return {expression};");
        self.call("POST", "/execute/sync", &json!({"script": script, "args": []}))
    }

    /// Presses a key on an element.
    fn press(&self, selector: &str, key: char) {
        let find = json!({"using": "css selector", "value": selector});
        let found = self.call("POST", "/element", &find);
        let element = found.as_object().unwrap().values().next().unwrap().as_str().unwrap();
        self.call("POST", &format!("/element/{element}/value"), &json!({"text": key.to_string()}));
    }

    /// What the console of the page says since the last call.
    fn said(&self) -> Value {
        self.call("POST", "/se/log", &json!({"type": "browser"}))
    }
}

/// The keys → and End, as WebDriver numbers them.
const RIGHT: char = '\u{e014}';
const END: char = '\u{e010}';

fn tltlc(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_tltlc"))
        .args(arguments)
        .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cli"))
        .output()
        .unwrap();
    assert!(output.status.code().is_some_and(|code| code < 2), "{arguments:?}: {output:?}");
    String::from_utf8(output.stdout).unwrap()
}

fn file(name: &str, text: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, text).unwrap();
    path
}

/// The page of a run, and its rows as CSV has them: state and verdict.
fn page(name: &str, arguments: &[&str]) -> (PathBuf, Vec<(String, String)>) {
    let written = |format: &str| tltlc(&[&["run"], arguments, &["--format", format]].concat());
    let row = |line: &str| {
        let fields: Vec<_> = line.split(',').collect();
        (fields[1].to_owned(), fields[3].to_owned())
    };
    let csv = written("csv");
    (file(&format!("{name}.html"), &written("html")), csv.lines().skip(1).map(row).collect())
}

/// Recordings with all verdicts, with names that could be read as HTML, and a long one.
fn recordings() -> Vec<(&'static str, Vec<String>)> {
    let hostile = "</script><script>document.title=1</script>";
    let names = format!("\"{hostile}\",\"<img src=x onerror=alert(2)>\",\"a\u{202e}b\"\n");
    let hostile = file("hostile.csv", &(names + "-1,2,0\n1,-1,1\n1,2,3\n"));
    let mut long = String::from("a,b\n");
    for row in 0..100_000 {
        let _ = writeln!(long, "{},{}", f64::from(row % 1000) - 998.5, row - 99_990);
    }
    let (long, lost) = (file("long.csv", &long), file("lost.csv", "a,b\n-1,-1\n-1,1\n1,1\n"));
    let own = |words: &[&str]| words.iter().map(|word| (*word).to_owned()).collect();
    vec![
        ("satisfied", own(&["arm.tltl:pick", "arm.csv"])),
        ("lost", own(&["!b U a", lost.to_str().unwrap()])),
        ("open", own(&["F (a && X !b)", lost.to_str().unwrap()])),
        (
            "hostile",
            own(&[
                "F \"</script><script>document.title=1</script>\" && \
                 F (\"<img src=x onerror=alert(2)>\" && F \"a\u{202e}b\")",
                hostile.to_str().unwrap(),
            ]),
        ),
        ("long", own(&["F (a && X F b)", long.to_str().unwrap()])),
    ]
}

#[test]
fn the_slider_shows_what_the_automaton_did() {
    let Some(browser) = Browser::start() else {
        eprintln!("skipped: there is no chromedriver, so no browser reads the pages");
        return;
    };
    for (name, arguments) in recordings() {
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let (page, rows) = page(name, &arguments);
        browser.open(&page);
        let state = || browser.read("document.querySelector('#state').textContent");
        let verdict = || browser.read("document.querySelector('#verdict').textContent");
        for (row, (q, told)) in rows.iter().enumerate().take(5) {
            let shown = browser.read("document.querySelector('#row').value");
            let is_row = shown.as_str().unwrap().starts_with(&format!("row {row} of "));
            if is_row {
                assert_eq!((state(), verdict()), (json!(q), json!(told)), "{name}, row {row}");
            }
            assert!(is_row || name == "long", "{name}: {shown}");
            browser.press("#slider", RIGHT);
        }
        browser.press("#slider", END);
        let (q, told) = rows.last().unwrap();
        assert_eq!((state(), verdict()), (json!(q), json!(told)), "{name}, the last row");
        let marked = browser.read("document.querySelectorAll('#here circle').length");
        assert_eq!(marked, 1, "{name}: the state is marked in the picture");
        let asks = browser.read("document.querySelector('#now dl').textContent");
        let alike = format!("document.querySelector('#asks [data-state=\"{q}\"] dl').textContent");
        assert_eq!(asks, browser.read(&alike), "{name}");
        // No name became an element, and the page fetched nothing.
        assert_eq!(browser.read("document.scripts.length + document.images.length"), 2, "{name}");
        assert_eq!(browser.read("performance.getEntriesByType('resource').length"), 0, "{name}");
        assert_eq!(browser.said(), json!([]), "{name}");
    }
    grounds(&browser);
    explained(&browser);
}

/// The page keeps to the ground that its reader has chosen, and its text can be read on it.
fn grounds(browser: &Browser) {
    let colours = |scheme: &str| -> [f64; 2] {
        let feature = json!([{"name": "prefers-color-scheme", "value": scheme}]);
        let parameters = json!({"features": feature});
        let call = json!({"cmd": "Emulation.setEmulatedMedia", "params": parameters});
        browser.call("POST", "/goog/cdp/execute", &call);
        let style = |name: &str| {
            let colour = browser.read(&format!("getComputedStyle(document.body).{name}"));
            let digits = |c: char| !c.is_ascii_digit();
            let parts = colour.as_str().unwrap().split(digits).filter(|part| !part.is_empty());
            let [r, g, b] = [0, 1, 2].map(|i| parts.clone().nth(i).unwrap().parse().unwrap());
            luminance(r) * 0.2126 + luminance(g) * 0.7152 + luminance(b) * 0.0722
        };
        [style("backgroundColor"), style("color")]
    };
    let ([white, ink], [black, chalk]) = (colours("light"), colours("dark"));
    for [bright, dark] in [[white, ink], [chalk, black]] {
        let contrast = (bright + 0.05) / (dark + 0.05);
        assert!(contrast >= 7.0, "WCAG 2.2 asks for 7 at its highest level: {contrast}");
    }
}

/// The share of one channel of sRGB in the relative luminance, as WCAG defines it.
fn luminance(channel: f64) -> f64 {
    let c = channel / 255.0;
    if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

/// The page of `explain` goes through the shortest trajectories.
fn explained(browser: &Browser) {
    browser.open(&file("explained.html", &tltlc(&["explain", "!c U a", "--format", "html"])));
    let options = "document.querySelectorAll('#trajectory option').length";
    assert_eq!(browser.read(options), 2);
    assert_eq!(browser.read("document.querySelector('#verdict').textContent"), "satisfied");
    browser.press("#trajectory", '\u{e015}');
    assert_eq!(browser.read("document.querySelector('#verdict').textContent"), "lost");
    // Of many states the first are explained, and those that are shown.
    let many = (0..9).map(|i| format!("F p{i}")).collect::<Vec<_>>().join(" && ");
    browser.open(&file("many.html", &tltlc(&["explain", &many, "--format", "html"])));
    let asks = browser.read("document.querySelector('#now dl').textContent");
    assert_eq!(asks, "asks fornothing: the task is satisfied");
    assert_eq!(browser.said(), json!([]));
}
