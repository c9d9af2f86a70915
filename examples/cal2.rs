use frictcomp::circle::*;
fn main(){
    let plant = Preset::Stiff.plant();
    for feed in [500.,1000.,2000.0,5000.0]{
        let test = CircularTest{circle:Circle{feed,..Circle::default()},model:FrictionModel::Lugre,list:plant_list(&plant.x),plant:plant.clone(),reading:Default::default()};
        let o=Outcome::of([test.run(Job::ALL[2]).unwrap(),test.run(Job::ALL[3]).unwrap()]);
        println!(" {:.3} H {:.3} {:?} {:?}",o.on.figures.glitch_max(),o.on.figures.h.unwrap(),o.on.figures.ccw.as_ref().unwrap().glitch.iter().map(|g|(g.height*1000.).round()/1000.).collect::<Vec<_>>(),o.on.figures.cw.as_ref().unwrap().glitch.iter().map(|g|(g.height*1000.).round()/1000.).collect::<Vec<_>>());
    } 
}
