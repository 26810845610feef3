use rigidtap::config::MachineFile;
#[test]
fn show() {
    println!("{}", MachineFile::reference().to_toml());
}
